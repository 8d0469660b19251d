struct RsmssResult {
    float value;
    uint case_id;
};

struct RsmssSite {
    uint row;
};

static const uint RSMSS_H_NONE = 0u;
static const uint RSMSS_H_RIGHT = 1u;
static const uint RSMSS_H_LEFT = 2u;
static const uint RSMSS_H_BOTH = 3u;
static const uint RSMSS_V_NONE = 0u;
static const uint RSMSS_V_TOP = 1u;
static const uint RSMSS_V_BOTTOM = 2u;
static const uint RSMSS_V_BOTH = 3u;
static const uint RSMSS_B_ENTERING = 0u;
static const uint RSMSS_B_EXITING = 1u;
static const uint RSMSS_TH_DUAL_NEGATIVE = 0u;
static const uint RSMSS_TH_POSITIVE_NEGATIVE = 1u;
static const uint RSMSS_TH_DUAL_POSITIVE = 2u;
static const uint RSMSS_DEFAULT = 4294967295u;

RWByteAddressBuffer umbrage_out : register(u2);
ByteAddressBuffer umbrage_fetched : register(t1);
ByteAddressBuffer umbrage_plain : register(t0);

uint rsmss_H_level(float code)
{
    return ((uint((code >= 0.125)) + uint((code >= 0.375))) + uint((code >= 0.625)));
}

uint rsmss_V_level(float code_1)
{
    return ((uint((code_1 >= 0.125)) + uint((code_1 >= 0.375))) + uint((code_1 >= 0.625)));
}

uint rsmss_b_level(float code_2)
{
    return uint((code_2 >= 0.5));
}

uint rsmss_tH_level(float code_3)
{
    return (uint((code_3 >= -0.5)) + uint((code_3 >= 0.5)));
}

uint rsmss_pack(float H, float V, float b, float tH, float tV, bool domH, bool domV)
{
    const uint _e7 = rsmss_H_level(H);
    const uint _e8 = rsmss_V_level(V);
    const uint _e12 = rsmss_b_level(b);
    const uint _e16 = rsmss_tH_level(tH);
    const uint _e20 = rsmss_tH_level(tV);
    return ((((((_e7 | (_e8 << 2u)) | (_e12 << 4u)) | (_e16 << 5u)) | (_e20 << 7u)) | (uint(domH) << 9u)) | (uint(domV) << 10u));
}

uint rsmss_lookup(uint word)
{
    switch(word) {
        case 4u:
        case 12u:
        case 20u:
        case 36u:
        case 44u:
        case 68u:
        case 84u:
        case 132u:
        case 140u:
        case 148u:
        case 164u:
        case 172u:
        case 196u:
        case 212u:
        case 260u:
        case 268u:
        case 276u:
        case 292u:
        case 300u:
        case 324u:
        case 340u:
        case 388u:
        case 396u:
        case 404u:
        case 420u:
        case 428u:
        case 452u:
        case 468u: {
            return 436997121u;
        }
        case 5u:
        case 6u:
        case 13u:
        case 14u:
        case 21u:
        case 22u:
        case 37u:
        case 38u:
        case 45u:
        case 46u:
        case 69u:
        case 70u:
        case 85u:
        case 86u: {
            return 487657735u;
        }
        case 7u:
        case 15u:
        case 23u:
        case 39u:
        case 47u:
        case 55u:
        case 71u:
        case 79u:
        case 87u:
        case 135u:
        case 143u:
        case 151u:
        case 167u:
        case 175u:
        case 183u:
        case 199u:
        case 207u:
        case 215u:
        case 263u:
        case 271u:
        case 279u:
        case 295u:
        case 303u:
        case 311u:
        case 327u:
        case 335u:
        case 343u:
        case 391u:
        case 399u:
        case 407u:
        case 423u:
        case 431u:
        case 439u:
        case 455u:
        case 463u:
        case 471u: {
            return 521606922u;
        }
        case 40u:
        case 168u:
        case 296u:
        case 424u: {
            return 403376897u;
        }
        case 41u:
        case 42u: {
            return 453840134u;
        }
        case 43u:
        case 75u:
        case 171u:
        case 203u:
        case 299u:
        case 331u:
        case 427u:
        case 459u: {
            return 504698120u;
        }
        case 48u:
        case 176u:
        case 304u:
        case 432u: {
            return 402850563u;
        }
        case 49u:
        case 50u: {
            return 453840131u;
        }
        case 51u:
        case 83u:
        case 179u:
        case 211u:
        case 307u:
        case 339u:
        case 435u:
        case 467u: {
            return 504763913u;
        }
        case 52u:
        case 180u:
        case 308u:
        case 436u: {
            return 436536581u;
        }
        case 53u:
        case 54u: {
            return 487657733u;
        }
        case 72u:
        case 200u:
        case 328u:
        case 456u: {
            return 419561986u;
        }
        case 73u:
        case 74u: {
            return 470617346u;
        }
        case 76u:
        case 204u:
        case 332u:
        case 460u: {
            return 436470788u;
        }
        case 77u:
        case 78u: {
            return 487657732u;
        }
        case 80u:
        case 208u:
        case 336u:
        case 464u: {
            return 420154113u;
        }
        case 81u:
        case 82u: {
            return 470617350u;
        }
        case 133u:
        case 134u:
        case 141u:
        case 142u:
        case 149u:
        case 150u:
        case 165u:
        case 166u:
        case 173u:
        case 174u:
        case 197u:
        case 198u:
        case 213u:
        case 214u: {
            return 487789319u;
        }
        case 169u:
        case 170u: {
            return 453971718u;
        }
        case 177u:
        case 178u: {
            return 453971715u;
        }
        case 181u:
        case 182u: {
            return 487789317u;
        }
        case 201u:
        case 202u: {
            return 470748930u;
        }
        case 205u:
        case 206u: {
            return 487789316u;
        }
        case 209u:
        case 210u: {
            return 470748934u;
        }
        case 261u:
        case 262u:
        case 269u:
        case 270u:
        case 277u:
        case 278u:
        case 293u:
        case 294u:
        case 301u:
        case 302u:
        case 325u:
        case 326u:
        case 341u:
        case 342u: {
            return 487723527u;
        }
        case 297u:
        case 298u: {
            return 453905926u;
        }
        case 305u:
        case 306u: {
            return 453905923u;
        }
        case 309u:
        case 310u: {
            return 487723525u;
        }
        case 329u:
        case 330u: {
            return 470683138u;
        }
        case 333u:
        case 334u: {
            return 487723524u;
        }
        case 337u:
        case 338u: {
            return 470683142u;
        }
        case 389u:
        case 390u:
        case 397u:
        case 398u:
        case 405u:
        case 406u:
        case 421u:
        case 422u:
        case 429u:
        case 430u:
        case 453u:
        case 454u:
        case 469u:
        case 470u: {
            return 487855111u;
        }
        case 425u:
        case 426u: {
            return 454037510u;
        }
        case 433u:
        case 434u: {
            return 454037507u;
        }
        case 437u:
        case 438u: {
            return 487855109u;
        }
        case 457u:
        case 458u: {
            return 470814722u;
        }
        case 461u:
        case 462u: {
            return 487855108u;
        }
        case 465u:
        case 466u: {
            return 470814726u;
        }
        default: {
            break;
        }
    }
    return 0u;
}

uint rsmss_arm(uint key)
{
    const uint _e3 = rsmss_lookup((key >> 2u));
    return ((_e3 >> ((key & 3u) * 8u)) & 255u);
}

uint rsmss_fetch_d_cb_left(RsmssSite site)
{
    uint _e15 = asuint(umbrage_out.Load(((site.row * 4u) + 3u)*4));
    umbrage_out.Store(((site.row * 4u) + 3u)*4, asuint((_e15 + 1u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site.row * 10u) + 8u)*4));
    return _e25;
}

uint rsmss_fetch_d_cb_right(RsmssSite site_1)
{
    uint _e15 = asuint(umbrage_out.Load(((site_1.row * 4u) + 3u)*4));
    umbrage_out.Store(((site_1.row * 4u) + 3u)*4, asuint((_e15 + 16u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_1.row * 10u) + 9u)*4));
    return _e25;
}

uint rsmss_fetch_n_left(RsmssSite site_2)
{
    uint _e15 = asuint(umbrage_out.Load(((site_2.row * 4u) + 2u)*4));
    umbrage_out.Store(((site_2.row * 4u) + 2u)*4, asuint((_e15 + 256u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_2.row * 10u) + 2u)*4));
    return _e25;
}

uint rsmss_fetch_n_right(RsmssSite site_3)
{
    uint _e15 = asuint(umbrage_out.Load(((site_3.row * 4u) + 2u)*4));
    umbrage_out.Store(((site_3.row * 4u) + 2u)*4, asuint((_e15 + 4096u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_3.row * 10u) + 3u)*4));
    return _e25;
}

uint rsmss_fetch_d_cb_v(RsmssSite site_4)
{
    uint _e15 = asuint(umbrage_out.Load(((site_4.row * 4u) + 2u)*4));
    umbrage_out.Store(((site_4.row * 4u) + 2u)*4, asuint((_e15 + 1048576u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_4.row * 10u) + 5u)*4));
    return _e25;
}

uint rsmss_fetch_d_cb_top(RsmssSite site_5)
{
    uint _e15 = asuint(umbrage_out.Load(((site_5.row * 4u) + 2u)*4));
    umbrage_out.Store(((site_5.row * 4u) + 2u)*4, asuint((_e15 + 16777216u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_5.row * 10u) + 6u)*4));
    return _e25;
}

uint rsmss_fetch_d_cb_bottom(RsmssSite site_6)
{
    uint _e15 = asuint(umbrage_out.Load(((site_6.row * 4u) + 2u)*4));
    umbrage_out.Store(((site_6.row * 4u) + 2u)*4, asuint((_e15 + 268435456u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_6.row * 10u) + 7u)*4));
    return _e25;
}

uint rsmss_fetch_n_top(RsmssSite site_7)
{
    uint _e15 = asuint(umbrage_out.Load(((site_7.row * 4u) + 2u)*4));
    umbrage_out.Store(((site_7.row * 4u) + 2u)*4, asuint((_e15 + 1u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_7.row * 10u) + 0u)*4));
    return _e25;
}

uint rsmss_fetch_n_bottom(RsmssSite site_8)
{
    uint _e15 = asuint(umbrage_out.Load(((site_8.row * 4u) + 2u)*4));
    umbrage_out.Store(((site_8.row * 4u) + 2u)*4, asuint((_e15 + 16u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_8.row * 10u) + 1u)*4));
    return _e25;
}

uint rsmss_fetch_d_cb_h(RsmssSite site_9)
{
    uint _e15 = asuint(umbrage_out.Load(((site_9.row * 4u) + 2u)*4));
    umbrage_out.Store(((site_9.row * 4u) + 2u)*4, asuint((_e15 + 65536u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_9.row * 10u) + 4u)*4));
    return _e25;
}

RsmssResult ConstructRsmssResult(float arg0, uint arg1) {
    RsmssResult ret = (RsmssResult)0;
    ret.value = arg0;
    ret.case_id = arg1;
    return ret;
}

RsmssResult rsmss_key_case(uint key_1, float dH, float dV, float px, float py, RsmssSite site_10)
{
    bool local = (bool)0;
    bool local_1 = (bool)0;
    bool local_2 = (bool)0;
    bool local_3 = (bool)0;

    uint H_3 = (key_1 & 3u);
    uint V_3 = ((key_1 >> 2u) & 3u);
    uint b_3 = ((key_1 >> 4u) & 1u);
    uint tH_3 = ((key_1 >> 5u) & 3u);
    uint tV_3 = ((key_1 >> 7u) & 3u);
    const uint _e24 = rsmss_arm(key_1);
    switch(_e24) {
        case 0u: {
            const RsmssResult rsmssresult = ConstructRsmssResult(1.0, 1u);
            return rsmssresult;
        }
        case 1u: {
            const RsmssResult rsmssresult_1 = ConstructRsmssResult(clamp(((b_3 == RSMSS_B_ENTERING) ? 1.0 : 0.0), 0.0, 1.0), RSMSS_DEFAULT);
            return rsmssresult_1;
        }
        case 2u: {
            if ((H_3 == RSMSS_H_LEFT)) {
                const RsmssResult rsmssresult_2 = ConstructRsmssResult(clamp(px, 0.0, 1.0), 21u);
                return rsmssresult_2;
            }
            if ((H_3 == RSMSS_H_RIGHT)) {
                const RsmssResult rsmssresult_3 = ConstructRsmssResult(clamp((1.0 - px), 0.0, 1.0), 21u);
                return rsmssresult_3;
            }
            const RsmssResult rsmssresult_4 = ConstructRsmssResult(1.0, 21u);
            return rsmssresult_4;
        }
        case 3u: {
            if ((V_3 == RSMSS_V_BOTTOM)) {
                const RsmssResult rsmssresult_5 = ConstructRsmssResult(clamp((1.0 - py), 0.0, 1.0), 20u);
                return rsmssresult_5;
            }
            if ((V_3 == RSMSS_V_TOP)) {
                const RsmssResult rsmssresult_6 = ConstructRsmssResult(clamp(py, 0.0, 1.0), 20u);
                return rsmssresult_6;
            }
            const RsmssResult rsmssresult_7 = ConstructRsmssResult(1.0, 20u);
            return rsmssresult_7;
        }
        case 4u: {
            if ((H_3 == RSMSS_H_LEFT)) {
                const RsmssResult rsmssresult_8 = ConstructRsmssResult(clamp((1.0 - px), 0.0, 1.0), 29u);
                return rsmssresult_8;
            }
            if ((H_3 == RSMSS_H_RIGHT)) {
                const RsmssResult rsmssresult_9 = ConstructRsmssResult(clamp(px, 0.0, 1.0), 29u);
                return rsmssresult_9;
            }
            const RsmssResult rsmssresult_10 = ConstructRsmssResult(0.0, 29u);
            return rsmssresult_10;
        }
        case 5u: {
            if ((V_3 == RSMSS_V_BOTTOM)) {
                const RsmssResult rsmssresult_11 = ConstructRsmssResult(clamp(py, 0.0, 1.0), 28u);
                return rsmssresult_11;
            }
            if ((V_3 == RSMSS_V_TOP)) {
                const RsmssResult rsmssresult_12 = ConstructRsmssResult(clamp((1.0 - py), 0.0, 1.0), 28u);
                return rsmssresult_12;
            }
            const RsmssResult rsmssresult_13 = ConstructRsmssResult(0.0, 28u);
            return rsmssresult_13;
        }
        case 6u: {
            float F22_ = ((V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH));
            const RsmssResult rsmssresult_14 = ConstructRsmssResult(clamp(F22_, 0.0, 1.0), 22u);
            return rsmssresult_14;
        }
        case 7u: {
            float F30_ = ((V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py));
            const RsmssResult rsmssresult_15 = ConstructRsmssResult(clamp(F30_, 0.0, 1.0), 30u);
            return rsmssresult_15;
        }
        case 8u: {
            const uint _e140 = rsmss_fetch_d_cb_left(site_10);
            if ((_e140 == RSMSS_V_NONE)) {
                const RsmssResult rsmssresult_16 = ConstructRsmssResult(clamp((1.0 - dH), 0.0, 1.0), 11u);
                return rsmssresult_16;
            }
            const uint _e150 = rsmss_fetch_d_cb_right(site_10);
            if ((_e150 == RSMSS_V_NONE)) {
                const RsmssResult rsmssresult_17 = ConstructRsmssResult(clamp((1.0 - dH), 0.0, 1.0), 11u);
                return rsmssresult_17;
            }
            if (!((_e140 == RSMSS_V_TOP))) {
                local = (_e150 == RSMSS_V_TOP);
            } else {
                local = true;
            }
            bool _e168 = local;
            if (_e168) {
                const RsmssResult rsmssresult_18 = ConstructRsmssResult(clamp(((1.0 + py) - dH), 0.0, 1.0), 11u);
                return rsmssresult_18;
            }
            if (!((_e140 == RSMSS_V_BOTTOM))) {
                local_1 = (_e150 == RSMSS_V_BOTTOM);
            } else {
                local_1 = true;
            }
            bool _e185 = local_1;
            if (_e185) {
                const RsmssResult rsmssresult_19 = ConstructRsmssResult(clamp(((2.0 - py) - dH), 0.0, 1.0), 11u);
                return rsmssresult_19;
            }
            const RsmssResult rsmssresult_20 = ConstructRsmssResult(1.0, 11u);
            return rsmssresult_20;
        }
        case 9u: {
            const uint _e197 = rsmss_fetch_n_left(site_10);
            if ((_e197 == RSMSS_V_BOTH)) {
                const uint _e200 = rsmss_fetch_n_right(site_10);
                if ((_e200 == RSMSS_V_BOTH)) {
                    const RsmssResult rsmssresult_21 = ConstructRsmssResult(0.0, 6u);
                    return rsmssresult_21;
                }
                if ((_e200 == RSMSS_V_TOP)) {
                    const RsmssResult rsmssresult_22 = ConstructRsmssResult(clamp(((px + py) - 1.0), 0.0, 1.0), 6u);
                    return rsmssresult_22;
                }
                if ((_e200 == RSMSS_V_BOTTOM)) {
                    const RsmssResult rsmssresult_23 = ConstructRsmssResult(clamp((px - py), 0.0, 1.0), 6u);
                    return rsmssresult_23;
                }
                const RsmssResult rsmssresult_24 = ConstructRsmssResult(1.0, 6u);
                return rsmssresult_24;
            }
            const uint _e227 = rsmss_fetch_n_right(site_10);
            if ((_e227 == RSMSS_V_TOP)) {
                const RsmssResult rsmssresult_25 = ConstructRsmssResult(clamp(((px + py) - 1.0), 0.0, 1.0), 6u);
                return rsmssresult_25;
            }
            if ((_e197 == RSMSS_V_TOP)) {
                const RsmssResult rsmssresult_26 = ConstructRsmssResult(clamp((py - px), 0.0, 1.0), 6u);
                return rsmssresult_26;
            }
            if ((_e227 == RSMSS_V_BOTTOM)) {
                const RsmssResult rsmssresult_27 = ConstructRsmssResult(clamp((px - py), 0.0, 1.0), 6u);
                return rsmssresult_27;
            }
            if ((_e197 == RSMSS_V_BOTTOM)) {
                const RsmssResult rsmssresult_28 = ConstructRsmssResult(clamp(((1.0 - px) - py), 0.0, 1.0), 6u);
                return rsmssresult_28;
            }
            const RsmssResult rsmssresult_29 = ConstructRsmssResult(1.0, 6u);
            return rsmssresult_29;
        }
        case 10u: {
            const uint _e267 = rsmss_fetch_d_cb_v(site_10);
            if ((_e267 == RSMSS_V_NONE)) {
                const RsmssResult rsmssresult_30 = ConstructRsmssResult(clamp(dH, 0.0, 1.0), 15u);
                return rsmssresult_30;
            }
            if ((_e267 == RSMSS_V_TOP)) {
                float A_v = ((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - py) : (dH - py));
                const RsmssResult rsmssresult_31 = ConstructRsmssResult(clamp(A_v, 0.0, 1.0), 15u);
                return rsmssresult_31;
            }
            if ((_e267 == RSMSS_V_BOTTOM)) {
                float B_v = ((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? py : ((dH + py) - 1.0));
                const RsmssResult rsmssresult_32 = ConstructRsmssResult(clamp(B_v, 0.0, 1.0), 15u);
                return rsmssresult_32;
            }
            const RsmssResult rsmssresult_33 = ConstructRsmssResult(0.0, 15u);
            return rsmssresult_33;
        }
        case 11u: {
            float F23_ = ((H_3 == RSMSS_H_LEFT) ? ((1.0 + px) - dV) : ((2.0 - px) - dV));
            const RsmssResult rsmssresult_34 = ConstructRsmssResult(clamp(F23_, 0.0, 1.0), 23u);
            return rsmssresult_34;
        }
        case 12u: {
            float F31_ = ((H_3 == RSMSS_H_LEFT) ? (dV - px) : ((px + dV) - 1.0));
            const RsmssResult rsmssresult_35 = ConstructRsmssResult(clamp(F31_, 0.0, 1.0), 31u);
            return rsmssresult_35;
        }
        case 13u: {
            float F22_1 = ((V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH));
            const RsmssResult rsmssresult_36 = ConstructRsmssResult(clamp(F22_1, 0.0, 1.0), 18u);
            return rsmssresult_36;
        }
        case 14u: {
            float F20_ = ((V_3 == RSMSS_V_BOTTOM) ? (1.0 - py) : py);
            float F22_2 = ((V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH));
            const RsmssResult rsmssresult_37 = ConstructRsmssResult(clamp(((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F20_ : F22_2), 0.0, 1.0), 17u);
            return rsmssresult_37;
        }
        case 15u: {
            float u = ((H_3 == RSMSS_H_LEFT) ? px : (1.0 - px));
            float F23_1 = ((H_3 == RSMSS_H_LEFT) ? ((1.0 + px) - dV) : ((2.0 - px) - dV));
            const RsmssResult rsmssresult_38 = ConstructRsmssResult(clamp(((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? u : F23_1), 0.0, 1.0), 16u);
            return rsmssresult_38;
        }
        case 16u: {
            float u_1 = ((H_3 == RSMSS_H_LEFT) ? px : (1.0 - px));
            float F23_2 = ((H_3 == RSMSS_H_LEFT) ? ((1.0 + px) - dV) : ((2.0 - px) - dV));
            float F20_1 = ((V_3 == RSMSS_V_BOTTOM) ? (1.0 - py) : py);
            float F22_3 = ((V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH));
            const RsmssResult rsmssresult_39 = ConstructRsmssResult(clamp(min(((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? u_1 : F23_2), ((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F20_1 : F22_3)), 0.0, 1.0), 19u);
            return rsmssresult_39;
        }
        case 17u: {
            float F30_1 = ((V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py));
            const RsmssResult rsmssresult_40 = ConstructRsmssResult(clamp(F30_1, 0.0, 1.0), 26u);
            return rsmssresult_40;
        }
        case 18u: {
            float F28_ = ((V_3 == RSMSS_V_BOTTOM) ? py : (1.0 - py));
            float F30_2 = ((V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py));
            const RsmssResult rsmssresult_41 = ConstructRsmssResult(clamp(((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F28_ : F30_2), 0.0, 1.0), 25u);
            return rsmssresult_41;
        }
        case 19u: {
            float F29_ = ((H_3 == RSMSS_H_LEFT) ? (1.0 - px) : px);
            float F31_1 = ((H_3 == RSMSS_H_LEFT) ? (dV - px) : ((px + dV) - 1.0));
            const RsmssResult rsmssresult_42 = ConstructRsmssResult(clamp(((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? F29_ : F31_1), 0.0, 1.0), 24u);
            return rsmssresult_42;
        }
        case 20u: {
            float F29_1 = ((H_3 == RSMSS_H_LEFT) ? (1.0 - px) : px);
            float F31_2 = ((H_3 == RSMSS_H_LEFT) ? (dV - px) : ((px + dV) - 1.0));
            float F28_1 = ((V_3 == RSMSS_V_BOTTOM) ? py : (1.0 - py));
            float F30_3 = ((V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py));
            const RsmssResult rsmssresult_43 = ConstructRsmssResult(clamp(max(((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? F29_1 : F31_2), ((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F28_1 : F30_3)), 0.0, 1.0), 27u);
            return rsmssresult_43;
        }
        case 21u: {
            const uint _e516 = rsmss_fetch_d_cb_v(site_10);
            if ((_e516 == RSMSS_V_NONE)) {
                const RsmssResult rsmssresult_44 = ConstructRsmssResult(clamp((1.0 - dH), 0.0, 1.0), 10u);
                return rsmssresult_44;
            }
            if ((_e516 == RSMSS_V_TOP)) {
                float u_2 = ((H_3 == RSMSS_H_LEFT) ? px : (1.0 - px));
                const RsmssResult rsmssresult_45 = ConstructRsmssResult(clamp(min(u_2, ((1.0 + py) - dH)), 0.0, 1.0), 10u);
                return rsmssresult_45;
            }
            if ((_e516 == RSMSS_V_BOTTOM)) {
                float u_3 = ((H_3 == RSMSS_H_LEFT) ? px : (1.0 - px));
                const RsmssResult rsmssresult_46 = ConstructRsmssResult(clamp(min(u_3, ((2.0 - py) - dH)), 0.0, 1.0), 10u);
                return rsmssresult_46;
            }
            const RsmssResult rsmssresult_47 = ConstructRsmssResult(1.0, 10u);
            return rsmssresult_47;
        }
        case 22u: {
            if ((H_3 == RSMSS_H_LEFT)) {
                const uint _e563 = rsmss_fetch_n_right(site_10);
                if ((_e563 == RSMSS_V_BOTH)) {
                    const RsmssResult rsmssresult_48 = ConstructRsmssResult(clamp(min(min(((1.0 + py) - dH), ((2.0 - py) - dH)), px), 0.0, 1.0), 7u);
                    return rsmssresult_48;
                }
                if ((_e563 == RSMSS_V_TOP)) {
                    const RsmssResult rsmssresult_49 = ConstructRsmssResult(clamp(((px + py) - 1.0), 0.0, 1.0), 7u);
                    return rsmssresult_49;
                }
                if ((_e563 == RSMSS_V_BOTTOM)) {
                    const RsmssResult rsmssresult_50 = ConstructRsmssResult(clamp((px - py), 0.0, 1.0), 7u);
                    return rsmssresult_50;
                }
                const RsmssResult rsmssresult_51 = ConstructRsmssResult(1.0, 7u);
                return rsmssresult_51;
            }
            const uint _e600 = rsmss_fetch_n_left(site_10);
            if ((_e600 == RSMSS_V_BOTH)) {
                const RsmssResult rsmssresult_52 = ConstructRsmssResult(clamp(min(min(((1.0 + py) - dH), ((2.0 - py) - dH)), (1.0 - px)), 0.0, 1.0), 7u);
                return rsmssresult_52;
            }
            if ((_e600 == RSMSS_V_TOP)) {
                const RsmssResult rsmssresult_53 = ConstructRsmssResult(clamp((py - px), 0.0, 1.0), 7u);
                return rsmssresult_53;
            }
            if ((_e600 == RSMSS_V_BOTTOM)) {
                const RsmssResult rsmssresult_54 = ConstructRsmssResult(clamp(((1.0 - px) - py), 0.0, 1.0), 7u);
                return rsmssresult_54;
            }
            const RsmssResult rsmssresult_55 = ConstructRsmssResult(1.0, 7u);
            return rsmssresult_55;
        }
        case 23u: {
            if ((H_3 == RSMSS_H_LEFT)) {
                const uint _e641 = rsmss_fetch_n_right(site_10);
                if ((_e641 == RSMSS_V_NONE)) {
                    const RsmssResult rsmssresult_56 = ConstructRsmssResult(clamp(dH, 0.0, 1.0), 14u);
                    return rsmssresult_56;
                }
                if ((_e641 == RSMSS_V_BOTTOM)) {
                    float B_v_1 = ((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? py : ((dH + py) - 1.0));
                    const RsmssResult rsmssresult_57 = ConstructRsmssResult(clamp(max((1.0 - px), B_v_1), 0.0, 1.0), 14u);
                    return rsmssresult_57;
                }
                if ((_e641 == RSMSS_V_TOP)) {
                    float A_v_1 = ((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - py) : (dH - py));
                    const RsmssResult rsmssresult_58 = ConstructRsmssResult(clamp(max((1.0 - px), A_v_1), 0.0, 1.0), 14u);
                    return rsmssresult_58;
                }
                const uint _e681 = rsmss_fetch_d_cb_v(site_10);
                if ((_e681 == RSMSS_V_NONE)) {
                    const RsmssResult rsmssresult_59 = ConstructRsmssResult(clamp(dH, 0.0, 1.0), 14u);
                    return rsmssresult_59;
                }
                if ((_e681 == RSMSS_V_TOP)) {
                    const RsmssResult rsmssresult_60 = ConstructRsmssResult(clamp(max((1.0 - px), (1.0 - py)), 0.0, 1.0), 14u);
                    return rsmssresult_60;
                }
                if ((_e681 == RSMSS_V_BOTTOM)) {
                    const RsmssResult rsmssresult_61 = ConstructRsmssResult(clamp(max((1.0 - px), py), 0.0, 1.0), 14u);
                    return rsmssresult_61;
                }
                const RsmssResult rsmssresult_62 = ConstructRsmssResult(0.0, 14u);
                return rsmssresult_62;
            }
            const uint _e714 = rsmss_fetch_n_left(site_10);
            if ((_e714 == RSMSS_V_NONE)) {
                const RsmssResult rsmssresult_63 = ConstructRsmssResult(clamp(dH, 0.0, 1.0), 14u);
                return rsmssresult_63;
            }
            if ((_e714 == RSMSS_V_BOTTOM)) {
                float B_v_2 = ((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? py : ((dH + py) - 1.0));
                const RsmssResult rsmssresult_64 = ConstructRsmssResult(clamp(max((1.0 - (1.0 - px)), B_v_2), 0.0, 1.0), 14u);
                return rsmssresult_64;
            }
            if ((_e714 == RSMSS_V_TOP)) {
                float A_v_2 = ((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - py) : (dH - py));
                const RsmssResult rsmssresult_65 = ConstructRsmssResult(clamp(max((1.0 - (1.0 - px)), A_v_2), 0.0, 1.0), 14u);
                return rsmssresult_65;
            }
            const uint _e758 = rsmss_fetch_d_cb_v(site_10);
            if ((_e758 == RSMSS_V_NONE)) {
                const RsmssResult rsmssresult_66 = ConstructRsmssResult(clamp(dH, 0.0, 1.0), 14u);
                return rsmssresult_66;
            }
            if ((_e758 == RSMSS_V_TOP)) {
                const RsmssResult rsmssresult_67 = ConstructRsmssResult(clamp(max((1.0 - (1.0 - px)), (1.0 - py)), 0.0, 1.0), 14u);
                return rsmssresult_67;
            }
            if ((_e758 == RSMSS_V_BOTTOM)) {
                const RsmssResult rsmssresult_68 = ConstructRsmssResult(clamp(max((1.0 - (1.0 - px)), py), 0.0, 1.0), 14u);
                return rsmssresult_68;
            }
            const RsmssResult rsmssresult_69 = ConstructRsmssResult(0.0, 14u);
            return rsmssresult_69;
        }
        case 24u: {
            const uint _e795 = rsmss_fetch_d_cb_top(site_10);
            if ((_e795 == RSMSS_H_NONE)) {
                const RsmssResult rsmssresult_70 = ConstructRsmssResult(clamp((1.0 - dV), 0.0, 1.0), 9u);
                return rsmssresult_70;
            }
            const uint _e805 = rsmss_fetch_d_cb_bottom(site_10);
            if ((_e805 == RSMSS_H_NONE)) {
                const RsmssResult rsmssresult_71 = ConstructRsmssResult(clamp((1.0 - dV), 0.0, 1.0), 9u);
                return rsmssresult_71;
            }
            if (!((_e795 == RSMSS_H_LEFT))) {
                local_2 = (_e805 == RSMSS_H_LEFT);
            } else {
                local_2 = true;
            }
            bool _e823 = local_2;
            if (_e823) {
                const RsmssResult rsmssresult_72 = ConstructRsmssResult(clamp(((1.0 + px) - dV), 0.0, 1.0), 9u);
                return rsmssresult_72;
            }
            if (!((_e795 == RSMSS_H_RIGHT))) {
                local_3 = (_e805 == RSMSS_H_RIGHT);
            } else {
                local_3 = true;
            }
            bool _e840 = local_3;
            if (_e840) {
                const RsmssResult rsmssresult_73 = ConstructRsmssResult(clamp(((2.0 - px) - dV), 0.0, 1.0), 9u);
                return rsmssresult_73;
            }
            const RsmssResult rsmssresult_74 = ConstructRsmssResult(1.0, 9u);
            return rsmssresult_74;
        }
        case 25u: {
            const uint _e852 = rsmss_fetch_n_top(site_10);
            if ((_e852 == RSMSS_H_BOTH)) {
                const uint _e855 = rsmss_fetch_n_bottom(site_10);
                if ((_e855 == RSMSS_H_BOTH)) {
                    const RsmssResult rsmssresult_75 = ConstructRsmssResult(0.0, 4u);
                    return rsmssresult_75;
                }
                if ((_e855 == RSMSS_H_LEFT)) {
                    const RsmssResult rsmssresult_76 = ConstructRsmssResult(clamp(((px + py) - 1.0), 0.0, 1.0), 4u);
                    return rsmssresult_76;
                }
                if ((_e855 == RSMSS_H_RIGHT)) {
                    const RsmssResult rsmssresult_77 = ConstructRsmssResult(clamp((py - px), 0.0, 1.0), 4u);
                    return rsmssresult_77;
                }
                const RsmssResult rsmssresult_78 = ConstructRsmssResult(1.0, 4u);
                return rsmssresult_78;
            }
            const uint _e882 = rsmss_fetch_n_bottom(site_10);
            if ((_e882 == RSMSS_H_LEFT)) {
                const RsmssResult rsmssresult_79 = ConstructRsmssResult(clamp(((px + py) - 1.0), 0.0, 1.0), 4u);
                return rsmssresult_79;
            }
            if ((_e882 == RSMSS_H_RIGHT)) {
                const RsmssResult rsmssresult_80 = ConstructRsmssResult(clamp((py - px), 0.0, 1.0), 4u);
                return rsmssresult_80;
            }
            if ((_e852 == RSMSS_H_LEFT)) {
                const RsmssResult rsmssresult_81 = ConstructRsmssResult(clamp((px - py), 0.0, 1.0), 4u);
                return rsmssresult_81;
            }
            if ((_e852 == RSMSS_H_RIGHT)) {
                const RsmssResult rsmssresult_82 = ConstructRsmssResult(clamp(((1.0 - px) - py), 0.0, 1.0), 4u);
                return rsmssresult_82;
            }
            const RsmssResult rsmssresult_83 = ConstructRsmssResult(1.0, 4u);
            return rsmssresult_83;
        }
        case 26u: {
            const uint _e922 = rsmss_fetch_d_cb_h(site_10);
            if ((_e922 == RSMSS_H_NONE)) {
                const RsmssResult rsmssresult_84 = ConstructRsmssResult(clamp(dV, 0.0, 1.0), 13u);
                return rsmssresult_84;
            }
            if ((_e922 == RSMSS_H_LEFT)) {
                float A_h = ((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - px) : (dV - px));
                const RsmssResult rsmssresult_85 = ConstructRsmssResult(clamp(A_h, 0.0, 1.0), 13u);
                return rsmssresult_85;
            }
            if ((_e922 == RSMSS_H_RIGHT)) {
                float B_h = ((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? px : ((dV + px) - 1.0));
                const RsmssResult rsmssresult_86 = ConstructRsmssResult(clamp(B_h, 0.0, 1.0), 13u);
                return rsmssresult_86;
            }
            const RsmssResult rsmssresult_87 = ConstructRsmssResult(0.0, 13u);
            return rsmssresult_87;
        }
        case 27u: {
            const uint _e959 = rsmss_fetch_d_cb_h(site_10);
            if ((_e959 == RSMSS_H_NONE)) {
                const RsmssResult rsmssresult_88 = ConstructRsmssResult(clamp((1.0 - dV), 0.0, 1.0), 8u);
                return rsmssresult_88;
            }
            if ((_e959 == RSMSS_H_RIGHT)) {
                float w = ((V_3 == RSMSS_V_TOP) ? py : (1.0 - py));
                const RsmssResult rsmssresult_89 = ConstructRsmssResult(clamp(min(w, ((2.0 - px) - dV)), 0.0, 1.0), 8u);
                return rsmssresult_89;
            }
            if ((_e959 == RSMSS_H_LEFT)) {
                float w_1 = ((V_3 == RSMSS_V_TOP) ? py : (1.0 - py));
                const RsmssResult rsmssresult_90 = ConstructRsmssResult(clamp(min(w_1, ((1.0 + px) - dV)), 0.0, 1.0), 8u);
                return rsmssresult_90;
            }
            const RsmssResult rsmssresult_91 = ConstructRsmssResult(1.0, 8u);
            return rsmssresult_91;
        }
        case 28u: {
            if ((V_3 == RSMSS_V_TOP)) {
                const uint _e1006 = rsmss_fetch_n_bottom(site_10);
                if ((_e1006 == RSMSS_H_BOTH)) {
                    const RsmssResult rsmssresult_92 = ConstructRsmssResult(clamp(min(min(((1.0 + px) - dV), ((2.0 - px) - dV)), py), 0.0, 1.0), 5u);
                    return rsmssresult_92;
                }
                if ((_e1006 == RSMSS_H_LEFT)) {
                    const RsmssResult rsmssresult_93 = ConstructRsmssResult(clamp(((px + py) - 1.0), 0.0, 1.0), 5u);
                    return rsmssresult_93;
                }
                if ((_e1006 == RSMSS_H_RIGHT)) {
                    const RsmssResult rsmssresult_94 = ConstructRsmssResult(clamp((py - px), 0.0, 1.0), 5u);
                    return rsmssresult_94;
                }
                const RsmssResult rsmssresult_95 = ConstructRsmssResult(1.0, 5u);
                return rsmssresult_95;
            }
            const uint _e1043 = rsmss_fetch_n_top(site_10);
            if ((_e1043 == RSMSS_H_BOTH)) {
                const RsmssResult rsmssresult_96 = ConstructRsmssResult(clamp(min(min(((1.0 + px) - dV), ((2.0 - px) - dV)), (1.0 - py)), 0.0, 1.0), 5u);
                return rsmssresult_96;
            }
            if ((_e1043 == RSMSS_H_LEFT)) {
                const RsmssResult rsmssresult_97 = ConstructRsmssResult(clamp((px - py), 0.0, 1.0), 5u);
                return rsmssresult_97;
            }
            if ((_e1043 == RSMSS_H_RIGHT)) {
                const RsmssResult rsmssresult_98 = ConstructRsmssResult(clamp(((1.0 - px) - py), 0.0, 1.0), 5u);
                return rsmssresult_98;
            }
            const RsmssResult rsmssresult_99 = ConstructRsmssResult(1.0, 5u);
            return rsmssresult_99;
        }
        case 29u: {
            if ((V_3 == RSMSS_V_TOP)) {
                const uint _e1084 = rsmss_fetch_n_bottom(site_10);
                if ((_e1084 == RSMSS_H_NONE)) {
                    const RsmssResult rsmssresult_100 = ConstructRsmssResult(clamp(dV, 0.0, 1.0), 12u);
                    return rsmssresult_100;
                }
                if ((_e1084 == RSMSS_H_RIGHT)) {
                    float B_h_1 = ((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? px : ((dV + px) - 1.0));
                    const RsmssResult rsmssresult_101 = ConstructRsmssResult(clamp(max((1.0 - py), B_h_1), 0.0, 1.0), 12u);
                    return rsmssresult_101;
                }
                if ((_e1084 == RSMSS_H_LEFT)) {
                    float A_h_1 = ((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - px) : (dV - px));
                    const RsmssResult rsmssresult_102 = ConstructRsmssResult(clamp(max((1.0 - py), A_h_1), 0.0, 1.0), 12u);
                    return rsmssresult_102;
                }
                const uint _e1124 = rsmss_fetch_d_cb_h(site_10);
                if ((_e1124 == RSMSS_H_NONE)) {
                    const RsmssResult rsmssresult_103 = ConstructRsmssResult(clamp(dV, 0.0, 1.0), 12u);
                    return rsmssresult_103;
                }
                if ((_e1124 == RSMSS_H_LEFT)) {
                    const RsmssResult rsmssresult_104 = ConstructRsmssResult(clamp(max((1.0 - py), (1.0 - px)), 0.0, 1.0), 12u);
                    return rsmssresult_104;
                }
                if ((_e1124 == RSMSS_H_RIGHT)) {
                    const RsmssResult rsmssresult_105 = ConstructRsmssResult(clamp(max((1.0 - py), px), 0.0, 1.0), 12u);
                    return rsmssresult_105;
                }
                const RsmssResult rsmssresult_106 = ConstructRsmssResult(0.0, 12u);
                return rsmssresult_106;
            }
            const uint _e1157 = rsmss_fetch_n_top(site_10);
            if ((_e1157 == RSMSS_H_NONE)) {
                const RsmssResult rsmssresult_107 = ConstructRsmssResult(clamp(dV, 0.0, 1.0), 12u);
                return rsmssresult_107;
            }
            if ((_e1157 == RSMSS_H_RIGHT)) {
                float B_h_2 = ((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? px : ((dV + px) - 1.0));
                const RsmssResult rsmssresult_108 = ConstructRsmssResult(clamp(max((1.0 - (1.0 - py)), B_h_2), 0.0, 1.0), 12u);
                return rsmssresult_108;
            }
            if ((_e1157 == RSMSS_H_LEFT)) {
                float A_h_2 = ((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - px) : (dV - px));
                const RsmssResult rsmssresult_109 = ConstructRsmssResult(clamp(max((1.0 - (1.0 - py)), A_h_2), 0.0, 1.0), 12u);
                return rsmssresult_109;
            }
            const uint _e1201 = rsmss_fetch_d_cb_h(site_10);
            if ((_e1201 == RSMSS_H_NONE)) {
                const RsmssResult rsmssresult_110 = ConstructRsmssResult(clamp(dV, 0.0, 1.0), 12u);
                return rsmssresult_110;
            }
            if ((_e1201 == RSMSS_H_LEFT)) {
                const RsmssResult rsmssresult_111 = ConstructRsmssResult(clamp(max((1.0 - (1.0 - py)), (1.0 - px)), 0.0, 1.0), 12u);
                return rsmssresult_111;
            }
            if ((_e1201 == RSMSS_H_RIGHT)) {
                const RsmssResult rsmssresult_112 = ConstructRsmssResult(clamp(max((1.0 - (1.0 - py)), px), 0.0, 1.0), 12u);
                return rsmssresult_112;
            }
            const RsmssResult rsmssresult_113 = ConstructRsmssResult(0.0, 12u);
            return rsmssresult_113;
        }
        case 30u: {
            const RsmssResult rsmssresult_114 = ConstructRsmssResult(0.0, 2u);
            return rsmssresult_114;
        }
        default: {
            break;
        }
    }
    const RsmssResult rsmssresult_115 = ConstructRsmssResult(1.0, 3u);
    return rsmssresult_115;
}

float rsmss_key(uint key_2, float dH_1, float dV_1, float px_1, float py_1, RsmssSite site_11)
{
    const RsmssResult _e6 = rsmss_key_case(key_2, dH_1, dV_1, px_1, py_1, site_11);
    return _e6.value;
}

RsmssResult rsmss_case(float H_1, float V_1, float b_1, float tH_1, float tV_1, float dH_2, float dV_2, float px_2, float py_2, bool domH_1, bool domV_1, RsmssSite site_12)
{
    const uint _e12 = rsmss_pack(H_1, V_1, b_1, tH_1, tV_1, domH_1, domV_1);
    const RsmssResult _e13 = rsmss_key_case(_e12, dH_2, dV_2, px_2, py_2, site_12);
    const RsmssResult rsmssresult_116 = _e13;
    return rsmssresult_116;
}

float rsmss(float H_2, float V_2, float b_2, float tH_2, float tV_2, float dH_3, float dV_3, float px_3, float py_3, bool domH_2, bool domV_2, RsmssSite site_13)
{
    const RsmssResult _e12 = rsmss_case(H_2, V_2, b_2, tH_2, tV_2, dH_3, dV_3, px_3, py_3, domH_2, domV_2, site_13);
    return _e12.value;
}

RsmssSite ConstructRsmssSite(uint arg0) {
    RsmssSite ret = (RsmssSite)0;
    ret.row = arg0;
    return ret;
}

[numthreads(64, 1, 1)]
void rsmss_columns(uint3 id : SV_DispatchThreadID)
{
    uint row = id.x;
    uint _e4 = asuint(umbrage_plain.Load(0));
    if ((row >= _e4)) {
        return;
    }
    uint at = (1u + (row * 5u));
    uint _e14 = asuint(umbrage_plain.Load((at + 0u)*4));
    uint _e19 = asuint(umbrage_plain.Load((at + 1u)*4));
    uint _e25 = asuint(umbrage_plain.Load((at + 2u)*4));
    uint _e31 = asuint(umbrage_plain.Load((at + 3u)*4));
    uint _e37 = asuint(umbrage_plain.Load((at + 4u)*4));
    const RsmssResult _e40 = rsmss_key_case(_e14, asfloat(_e19), asfloat(_e25), asfloat(_e31), asfloat(_e37), ConstructRsmssSite(row));
    umbrage_out.Store(((row * 4u) + 0u)*4, asuint(_e40.case_id));
    umbrage_out.Store(((row * 4u) + 1u)*4, asuint(asuint(_e40.value)));
    return;
}
