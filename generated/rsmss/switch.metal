// language: metal2.0
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct _mslBufferSizes {
    uint size0;
    uint size1;
    uint size2;
};

struct RsmssResult {
    float value;
    uint case_id;
};
struct RsmssSite {
    uint row;
};
typedef uint type_3[1];
constant uint RSMSS_H_NONE = 0u;
constant uint RSMSS_H_RIGHT = 1u;
constant uint RSMSS_H_LEFT = 2u;
constant uint RSMSS_H_BOTH = 3u;
constant uint RSMSS_V_NONE = 0u;
constant uint RSMSS_V_TOP = 1u;
constant uint RSMSS_V_BOTTOM = 2u;
constant uint RSMSS_V_BOTH = 3u;
constant uint RSMSS_B_ENTERING = 0u;
constant uint RSMSS_B_EXITING = 1u;
constant uint RSMSS_TH_DUAL_NEGATIVE = 0u;
constant uint RSMSS_TH_POSITIVE_NEGATIVE = 1u;
constant uint RSMSS_TH_DUAL_POSITIVE = 2u;
constant uint RSMSS_DEFAULT = 4294967295u;

uint rsmss_H_level(
    float code
) {
    return (static_cast<uint>(code >= 0.125) + static_cast<uint>(code >= 0.375)) + static_cast<uint>(code >= 0.625);
}

uint rsmss_V_level(
    float code_1
) {
    return (static_cast<uint>(code_1 >= 0.125) + static_cast<uint>(code_1 >= 0.375)) + static_cast<uint>(code_1 >= 0.625);
}

uint rsmss_b_level(
    float code_2
) {
    return static_cast<uint>(code_2 >= 0.5);
}

uint rsmss_tH_level(
    float code_3
) {
    return static_cast<uint>(code_3 >= -0.5) + static_cast<uint>(code_3 >= 0.5);
}

uint rsmss_pack(
    float H,
    float V,
    float b,
    float tH,
    float tV,
    bool domH,
    bool domV
) {
    uint _e7 = rsmss_H_level(H);
    uint _e8 = rsmss_V_level(V);
    uint _e12 = rsmss_b_level(b);
    uint _e16 = rsmss_tH_level(tH);
    uint _e20 = rsmss_tH_level(tV);
    return (((((_e7 | (_e8 << 2u)) | (_e12 << 4u)) | (_e16 << 5u)) | (_e20 << 7u)) | (static_cast<uint>(domH) << 9u)) | (static_cast<uint>(domV) << 10u);
}

uint rsmss_lookup(
    uint word
) {
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

uint rsmss_arm(
    uint key
) {
    uint _e3 = rsmss_lookup(key >> 2u);
    return (_e3 >> ((key & 3u) * 8u)) & 255u;
}

uint rsmss_fetch_d_cb_left(
    RsmssSite site,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site.row * 4u) + 3u];
    umbrage_out[(site.row * 4u) + 3u] = _e15 + 1u;
    uint _e25 = umbrage_fetched[(site.row * 10u) + 8u];
    return _e25;
}

uint rsmss_fetch_d_cb_right(
    RsmssSite site_1,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_1.row * 4u) + 3u];
    umbrage_out[(site_1.row * 4u) + 3u] = _e15 + 16u;
    uint _e25 = umbrage_fetched[(site_1.row * 10u) + 9u];
    return _e25;
}

uint rsmss_fetch_n_left(
    RsmssSite site_2,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_2.row * 4u) + 2u];
    umbrage_out[(site_2.row * 4u) + 2u] = _e15 + 256u;
    uint _e25 = umbrage_fetched[(site_2.row * 10u) + 2u];
    return _e25;
}

uint rsmss_fetch_n_right(
    RsmssSite site_3,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_3.row * 4u) + 2u];
    umbrage_out[(site_3.row * 4u) + 2u] = _e15 + 4096u;
    uint _e25 = umbrage_fetched[(site_3.row * 10u) + 3u];
    return _e25;
}

uint rsmss_fetch_d_cb_v(
    RsmssSite site_4,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_4.row * 4u) + 2u];
    umbrage_out[(site_4.row * 4u) + 2u] = _e15 + 1048576u;
    uint _e25 = umbrage_fetched[(site_4.row * 10u) + 5u];
    return _e25;
}

uint rsmss_fetch_d_cb_top(
    RsmssSite site_5,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_5.row * 4u) + 2u];
    umbrage_out[(site_5.row * 4u) + 2u] = _e15 + 16777216u;
    uint _e25 = umbrage_fetched[(site_5.row * 10u) + 6u];
    return _e25;
}

uint rsmss_fetch_d_cb_bottom(
    RsmssSite site_6,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_6.row * 4u) + 2u];
    umbrage_out[(site_6.row * 4u) + 2u] = _e15 + 268435456u;
    uint _e25 = umbrage_fetched[(site_6.row * 10u) + 7u];
    return _e25;
}

uint rsmss_fetch_n_top(
    RsmssSite site_7,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_7.row * 4u) + 2u];
    umbrage_out[(site_7.row * 4u) + 2u] = _e15 + 1u;
    uint _e25 = umbrage_fetched[(site_7.row * 10u) + 0u];
    return _e25;
}

uint rsmss_fetch_n_bottom(
    RsmssSite site_8,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_8.row * 4u) + 2u];
    umbrage_out[(site_8.row * 4u) + 2u] = _e15 + 16u;
    uint _e25 = umbrage_fetched[(site_8.row * 10u) + 1u];
    return _e25;
}

uint rsmss_fetch_d_cb_h(
    RsmssSite site_9,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_9.row * 4u) + 2u];
    umbrage_out[(site_9.row * 4u) + 2u] = _e15 + 65536u;
    uint _e25 = umbrage_fetched[(site_9.row * 10u) + 4u];
    return _e25;
}

RsmssResult rsmss_key_case(
    uint key_1,
    float dH,
    float dV,
    float px,
    float py,
    RsmssSite site_10,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    bool local = {};
    bool local_1 = {};
    bool local_2 = {};
    bool local_3 = {};
    uint H_3 = key_1 & 3u;
    uint V_3 = (key_1 >> 2u) & 3u;
    uint b_3 = (key_1 >> 4u) & 1u;
    uint tH_3 = (key_1 >> 5u) & 3u;
    uint tV_3 = (key_1 >> 7u) & 3u;
    uint _e24 = rsmss_arm(key_1);
    switch(_e24) {
        case 0u: {
            return RsmssResult {1.0, 1u};
        }
        case 1u: {
            return RsmssResult {metal::clamp((b_3 == RSMSS_B_ENTERING) ? 1.0 : 0.0, 0.0, 1.0), RSMSS_DEFAULT};
        }
        case 2u: {
            if (H_3 == RSMSS_H_LEFT) {
                return RsmssResult {metal::clamp(px, 0.0, 1.0), 21u};
            }
            if (H_3 == RSMSS_H_RIGHT) {
                return RsmssResult {metal::clamp(1.0 - px, 0.0, 1.0), 21u};
            }
            return RsmssResult {1.0, 21u};
        }
        case 3u: {
            if (V_3 == RSMSS_V_BOTTOM) {
                return RsmssResult {metal::clamp(1.0 - py, 0.0, 1.0), 20u};
            }
            if (V_3 == RSMSS_V_TOP) {
                return RsmssResult {metal::clamp(py, 0.0, 1.0), 20u};
            }
            return RsmssResult {1.0, 20u};
        }
        case 4u: {
            if (H_3 == RSMSS_H_LEFT) {
                return RsmssResult {metal::clamp(1.0 - px, 0.0, 1.0), 29u};
            }
            if (H_3 == RSMSS_H_RIGHT) {
                return RsmssResult {metal::clamp(px, 0.0, 1.0), 29u};
            }
            return RsmssResult {0.0, 29u};
        }
        case 5u: {
            if (V_3 == RSMSS_V_BOTTOM) {
                return RsmssResult {metal::clamp(py, 0.0, 1.0), 28u};
            }
            if (V_3 == RSMSS_V_TOP) {
                return RsmssResult {metal::clamp(1.0 - py, 0.0, 1.0), 28u};
            }
            return RsmssResult {0.0, 28u};
        }
        case 6u: {
            float F22_ = (V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH);
            return RsmssResult {metal::clamp(F22_, 0.0, 1.0), 22u};
        }
        case 7u: {
            float F30_ = (V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py);
            return RsmssResult {metal::clamp(F30_, 0.0, 1.0), 30u};
        }
        case 8u: {
            uint _e140 = rsmss_fetch_d_cb_left(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e140 == RSMSS_V_NONE) {
                return RsmssResult {metal::clamp(1.0 - dH, 0.0, 1.0), 11u};
            }
            uint _e150 = rsmss_fetch_d_cb_right(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e150 == RSMSS_V_NONE) {
                return RsmssResult {metal::clamp(1.0 - dH, 0.0, 1.0), 11u};
            }
            if (!((_e140 == RSMSS_V_TOP))) {
                local = _e150 == RSMSS_V_TOP;
            } else {
                local = true;
            }
            bool _e168 = local;
            if (_e168) {
                return RsmssResult {metal::clamp((1.0 + py) - dH, 0.0, 1.0), 11u};
            }
            if (!((_e140 == RSMSS_V_BOTTOM))) {
                local_1 = _e150 == RSMSS_V_BOTTOM;
            } else {
                local_1 = true;
            }
            bool _e185 = local_1;
            if (_e185) {
                return RsmssResult {metal::clamp((2.0 - py) - dH, 0.0, 1.0), 11u};
            }
            return RsmssResult {1.0, 11u};
        }
        case 9u: {
            uint _e197 = rsmss_fetch_n_left(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e197 == RSMSS_V_BOTH) {
                uint _e200 = rsmss_fetch_n_right(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
                if (_e200 == RSMSS_V_BOTH) {
                    return RsmssResult {0.0, 6u};
                }
                if (_e200 == RSMSS_V_TOP) {
                    return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 6u};
                }
                if (_e200 == RSMSS_V_BOTTOM) {
                    return RsmssResult {metal::clamp(px - py, 0.0, 1.0), 6u};
                }
                return RsmssResult {1.0, 6u};
            }
            uint _e227 = rsmss_fetch_n_right(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e227 == RSMSS_V_TOP) {
                return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 6u};
            }
            if (_e197 == RSMSS_V_TOP) {
                return RsmssResult {metal::clamp(py - px, 0.0, 1.0), 6u};
            }
            if (_e227 == RSMSS_V_BOTTOM) {
                return RsmssResult {metal::clamp(px - py, 0.0, 1.0), 6u};
            }
            if (_e197 == RSMSS_V_BOTTOM) {
                return RsmssResult {metal::clamp((1.0 - px) - py, 0.0, 1.0), 6u};
            }
            return RsmssResult {1.0, 6u};
        }
        case 10u: {
            uint _e267 = rsmss_fetch_d_cb_v(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e267 == RSMSS_V_NONE) {
                return RsmssResult {metal::clamp(dH, 0.0, 1.0), 15u};
            }
            if (_e267 == RSMSS_V_TOP) {
                float A_v = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - py) : (dH - py);
                return RsmssResult {metal::clamp(A_v, 0.0, 1.0), 15u};
            }
            if (_e267 == RSMSS_V_BOTTOM) {
                float B_v = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? py : ((dH + py) - 1.0);
                return RsmssResult {metal::clamp(B_v, 0.0, 1.0), 15u};
            }
            return RsmssResult {0.0, 15u};
        }
        case 11u: {
            float F23_ = (H_3 == RSMSS_H_LEFT) ? ((1.0 + px) - dV) : ((2.0 - px) - dV);
            return RsmssResult {metal::clamp(F23_, 0.0, 1.0), 23u};
        }
        case 12u: {
            float F31_ = (H_3 == RSMSS_H_LEFT) ? (dV - px) : ((px + dV) - 1.0);
            return RsmssResult {metal::clamp(F31_, 0.0, 1.0), 31u};
        }
        case 13u: {
            float F22_1 = (V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH);
            return RsmssResult {metal::clamp(F22_1, 0.0, 1.0), 18u};
        }
        case 14u: {
            float F20_ = (V_3 == RSMSS_V_BOTTOM) ? (1.0 - py) : py;
            float F22_2 = (V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH);
            return RsmssResult {metal::clamp((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F20_ : F22_2, 0.0, 1.0), 17u};
        }
        case 15u: {
            float u = (H_3 == RSMSS_H_LEFT) ? px : (1.0 - px);
            float F23_1 = (H_3 == RSMSS_H_LEFT) ? ((1.0 + px) - dV) : ((2.0 - px) - dV);
            return RsmssResult {metal::clamp((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? u : F23_1, 0.0, 1.0), 16u};
        }
        case 16u: {
            float u_1 = (H_3 == RSMSS_H_LEFT) ? px : (1.0 - px);
            float F23_2 = (H_3 == RSMSS_H_LEFT) ? ((1.0 + px) - dV) : ((2.0 - px) - dV);
            float F20_1 = (V_3 == RSMSS_V_BOTTOM) ? (1.0 - py) : py;
            float F22_3 = (V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH);
            return RsmssResult {metal::clamp(metal::min((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? u_1 : F23_2, (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F20_1 : F22_3), 0.0, 1.0), 19u};
        }
        case 17u: {
            float F30_1 = (V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py);
            return RsmssResult {metal::clamp(F30_1, 0.0, 1.0), 26u};
        }
        case 18u: {
            float F28_ = (V_3 == RSMSS_V_BOTTOM) ? py : (1.0 - py);
            float F30_2 = (V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py);
            return RsmssResult {metal::clamp((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F28_ : F30_2, 0.0, 1.0), 25u};
        }
        case 19u: {
            float F29_ = (H_3 == RSMSS_H_LEFT) ? (1.0 - px) : px;
            float F31_1 = (H_3 == RSMSS_H_LEFT) ? (dV - px) : ((px + dV) - 1.0);
            return RsmssResult {metal::clamp((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? F29_ : F31_1, 0.0, 1.0), 24u};
        }
        case 20u: {
            float F29_1 = (H_3 == RSMSS_H_LEFT) ? (1.0 - px) : px;
            float F31_2 = (H_3 == RSMSS_H_LEFT) ? (dV - px) : ((px + dV) - 1.0);
            float F28_1 = (V_3 == RSMSS_V_BOTTOM) ? py : (1.0 - py);
            float F30_3 = (V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py);
            return RsmssResult {metal::clamp(metal::max((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? F29_1 : F31_2, (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F28_1 : F30_3), 0.0, 1.0), 27u};
        }
        case 21u: {
            uint _e516 = rsmss_fetch_d_cb_v(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e516 == RSMSS_V_NONE) {
                return RsmssResult {metal::clamp(1.0 - dH, 0.0, 1.0), 10u};
            }
            if (_e516 == RSMSS_V_TOP) {
                float u_2 = (H_3 == RSMSS_H_LEFT) ? px : (1.0 - px);
                return RsmssResult {metal::clamp(metal::min(u_2, (1.0 + py) - dH), 0.0, 1.0), 10u};
            }
            if (_e516 == RSMSS_V_BOTTOM) {
                float u_3 = (H_3 == RSMSS_H_LEFT) ? px : (1.0 - px);
                return RsmssResult {metal::clamp(metal::min(u_3, (2.0 - py) - dH), 0.0, 1.0), 10u};
            }
            return RsmssResult {1.0, 10u};
        }
        case 22u: {
            if (H_3 == RSMSS_H_LEFT) {
                uint _e563 = rsmss_fetch_n_right(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
                if (_e563 == RSMSS_V_BOTH) {
                    return RsmssResult {metal::clamp(metal::min(metal::min((1.0 + py) - dH, (2.0 - py) - dH), px), 0.0, 1.0), 7u};
                }
                if (_e563 == RSMSS_V_TOP) {
                    return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 7u};
                }
                if (_e563 == RSMSS_V_BOTTOM) {
                    return RsmssResult {metal::clamp(px - py, 0.0, 1.0), 7u};
                }
                return RsmssResult {1.0, 7u};
            }
            uint _e600 = rsmss_fetch_n_left(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e600 == RSMSS_V_BOTH) {
                return RsmssResult {metal::clamp(metal::min(metal::min((1.0 + py) - dH, (2.0 - py) - dH), 1.0 - px), 0.0, 1.0), 7u};
            }
            if (_e600 == RSMSS_V_TOP) {
                return RsmssResult {metal::clamp(py - px, 0.0, 1.0), 7u};
            }
            if (_e600 == RSMSS_V_BOTTOM) {
                return RsmssResult {metal::clamp((1.0 - px) - py, 0.0, 1.0), 7u};
            }
            return RsmssResult {1.0, 7u};
        }
        case 23u: {
            if (H_3 == RSMSS_H_LEFT) {
                uint _e641 = rsmss_fetch_n_right(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
                if (_e641 == RSMSS_V_NONE) {
                    return RsmssResult {metal::clamp(dH, 0.0, 1.0), 14u};
                }
                if (_e641 == RSMSS_V_BOTTOM) {
                    float B_v_1 = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? py : ((dH + py) - 1.0);
                    return RsmssResult {metal::clamp(metal::max(1.0 - px, B_v_1), 0.0, 1.0), 14u};
                }
                if (_e641 == RSMSS_V_TOP) {
                    float A_v_1 = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - py) : (dH - py);
                    return RsmssResult {metal::clamp(metal::max(1.0 - px, A_v_1), 0.0, 1.0), 14u};
                }
                uint _e681 = rsmss_fetch_d_cb_v(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
                if (_e681 == RSMSS_V_NONE) {
                    return RsmssResult {metal::clamp(dH, 0.0, 1.0), 14u};
                }
                if (_e681 == RSMSS_V_TOP) {
                    return RsmssResult {metal::clamp(metal::max(1.0 - px, 1.0 - py), 0.0, 1.0), 14u};
                }
                if (_e681 == RSMSS_V_BOTTOM) {
                    return RsmssResult {metal::clamp(metal::max(1.0 - px, py), 0.0, 1.0), 14u};
                }
                return RsmssResult {0.0, 14u};
            }
            uint _e714 = rsmss_fetch_n_left(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e714 == RSMSS_V_NONE) {
                return RsmssResult {metal::clamp(dH, 0.0, 1.0), 14u};
            }
            if (_e714 == RSMSS_V_BOTTOM) {
                float B_v_2 = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? py : ((dH + py) - 1.0);
                return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - px), B_v_2), 0.0, 1.0), 14u};
            }
            if (_e714 == RSMSS_V_TOP) {
                float A_v_2 = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - py) : (dH - py);
                return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - px), A_v_2), 0.0, 1.0), 14u};
            }
            uint _e758 = rsmss_fetch_d_cb_v(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e758 == RSMSS_V_NONE) {
                return RsmssResult {metal::clamp(dH, 0.0, 1.0), 14u};
            }
            if (_e758 == RSMSS_V_TOP) {
                return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - px), 1.0 - py), 0.0, 1.0), 14u};
            }
            if (_e758 == RSMSS_V_BOTTOM) {
                return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - px), py), 0.0, 1.0), 14u};
            }
            return RsmssResult {0.0, 14u};
        }
        case 24u: {
            uint _e795 = rsmss_fetch_d_cb_top(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e795 == RSMSS_H_NONE) {
                return RsmssResult {metal::clamp(1.0 - dV, 0.0, 1.0), 9u};
            }
            uint _e805 = rsmss_fetch_d_cb_bottom(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e805 == RSMSS_H_NONE) {
                return RsmssResult {metal::clamp(1.0 - dV, 0.0, 1.0), 9u};
            }
            if (!((_e795 == RSMSS_H_LEFT))) {
                local_2 = _e805 == RSMSS_H_LEFT;
            } else {
                local_2 = true;
            }
            bool _e823 = local_2;
            if (_e823) {
                return RsmssResult {metal::clamp((1.0 + px) - dV, 0.0, 1.0), 9u};
            }
            if (!((_e795 == RSMSS_H_RIGHT))) {
                local_3 = _e805 == RSMSS_H_RIGHT;
            } else {
                local_3 = true;
            }
            bool _e840 = local_3;
            if (_e840) {
                return RsmssResult {metal::clamp((2.0 - px) - dV, 0.0, 1.0), 9u};
            }
            return RsmssResult {1.0, 9u};
        }
        case 25u: {
            uint _e852 = rsmss_fetch_n_top(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e852 == RSMSS_H_BOTH) {
                uint _e855 = rsmss_fetch_n_bottom(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
                if (_e855 == RSMSS_H_BOTH) {
                    return RsmssResult {0.0, 4u};
                }
                if (_e855 == RSMSS_H_LEFT) {
                    return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 4u};
                }
                if (_e855 == RSMSS_H_RIGHT) {
                    return RsmssResult {metal::clamp(py - px, 0.0, 1.0), 4u};
                }
                return RsmssResult {1.0, 4u};
            }
            uint _e882 = rsmss_fetch_n_bottom(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e882 == RSMSS_H_LEFT) {
                return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 4u};
            }
            if (_e882 == RSMSS_H_RIGHT) {
                return RsmssResult {metal::clamp(py - px, 0.0, 1.0), 4u};
            }
            if (_e852 == RSMSS_H_LEFT) {
                return RsmssResult {metal::clamp(px - py, 0.0, 1.0), 4u};
            }
            if (_e852 == RSMSS_H_RIGHT) {
                return RsmssResult {metal::clamp((1.0 - px) - py, 0.0, 1.0), 4u};
            }
            return RsmssResult {1.0, 4u};
        }
        case 26u: {
            uint _e922 = rsmss_fetch_d_cb_h(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e922 == RSMSS_H_NONE) {
                return RsmssResult {metal::clamp(dV, 0.0, 1.0), 13u};
            }
            if (_e922 == RSMSS_H_LEFT) {
                float A_h = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - px) : (dV - px);
                return RsmssResult {metal::clamp(A_h, 0.0, 1.0), 13u};
            }
            if (_e922 == RSMSS_H_RIGHT) {
                float B_h = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? px : ((dV + px) - 1.0);
                return RsmssResult {metal::clamp(B_h, 0.0, 1.0), 13u};
            }
            return RsmssResult {0.0, 13u};
        }
        case 27u: {
            uint _e959 = rsmss_fetch_d_cb_h(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e959 == RSMSS_H_NONE) {
                return RsmssResult {metal::clamp(1.0 - dV, 0.0, 1.0), 8u};
            }
            if (_e959 == RSMSS_H_RIGHT) {
                float w = (V_3 == RSMSS_V_TOP) ? py : (1.0 - py);
                return RsmssResult {metal::clamp(metal::min(w, (2.0 - px) - dV), 0.0, 1.0), 8u};
            }
            if (_e959 == RSMSS_H_LEFT) {
                float w_1 = (V_3 == RSMSS_V_TOP) ? py : (1.0 - py);
                return RsmssResult {metal::clamp(metal::min(w_1, (1.0 + px) - dV), 0.0, 1.0), 8u};
            }
            return RsmssResult {1.0, 8u};
        }
        case 28u: {
            if (V_3 == RSMSS_V_TOP) {
                uint _e1006 = rsmss_fetch_n_bottom(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
                if (_e1006 == RSMSS_H_BOTH) {
                    return RsmssResult {metal::clamp(metal::min(metal::min((1.0 + px) - dV, (2.0 - px) - dV), py), 0.0, 1.0), 5u};
                }
                if (_e1006 == RSMSS_H_LEFT) {
                    return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 5u};
                }
                if (_e1006 == RSMSS_H_RIGHT) {
                    return RsmssResult {metal::clamp(py - px, 0.0, 1.0), 5u};
                }
                return RsmssResult {1.0, 5u};
            }
            uint _e1043 = rsmss_fetch_n_top(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e1043 == RSMSS_H_BOTH) {
                return RsmssResult {metal::clamp(metal::min(metal::min((1.0 + px) - dV, (2.0 - px) - dV), 1.0 - py), 0.0, 1.0), 5u};
            }
            if (_e1043 == RSMSS_H_LEFT) {
                return RsmssResult {metal::clamp(px - py, 0.0, 1.0), 5u};
            }
            if (_e1043 == RSMSS_H_RIGHT) {
                return RsmssResult {metal::clamp((1.0 - px) - py, 0.0, 1.0), 5u};
            }
            return RsmssResult {1.0, 5u};
        }
        case 29u: {
            if (V_3 == RSMSS_V_TOP) {
                uint _e1084 = rsmss_fetch_n_bottom(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
                if (_e1084 == RSMSS_H_NONE) {
                    return RsmssResult {metal::clamp(dV, 0.0, 1.0), 12u};
                }
                if (_e1084 == RSMSS_H_RIGHT) {
                    float B_h_1 = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? px : ((dV + px) - 1.0);
                    return RsmssResult {metal::clamp(metal::max(1.0 - py, B_h_1), 0.0, 1.0), 12u};
                }
                if (_e1084 == RSMSS_H_LEFT) {
                    float A_h_1 = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - px) : (dV - px);
                    return RsmssResult {metal::clamp(metal::max(1.0 - py, A_h_1), 0.0, 1.0), 12u};
                }
                uint _e1124 = rsmss_fetch_d_cb_h(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
                if (_e1124 == RSMSS_H_NONE) {
                    return RsmssResult {metal::clamp(dV, 0.0, 1.0), 12u};
                }
                if (_e1124 == RSMSS_H_LEFT) {
                    return RsmssResult {metal::clamp(metal::max(1.0 - py, 1.0 - px), 0.0, 1.0), 12u};
                }
                if (_e1124 == RSMSS_H_RIGHT) {
                    return RsmssResult {metal::clamp(metal::max(1.0 - py, px), 0.0, 1.0), 12u};
                }
                return RsmssResult {0.0, 12u};
            }
            uint _e1157 = rsmss_fetch_n_top(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e1157 == RSMSS_H_NONE) {
                return RsmssResult {metal::clamp(dV, 0.0, 1.0), 12u};
            }
            if (_e1157 == RSMSS_H_RIGHT) {
                float B_h_2 = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? px : ((dV + px) - 1.0);
                return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - py), B_h_2), 0.0, 1.0), 12u};
            }
            if (_e1157 == RSMSS_H_LEFT) {
                float A_h_2 = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - px) : (dV - px);
                return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - py), A_h_2), 0.0, 1.0), 12u};
            }
            uint _e1201 = rsmss_fetch_d_cb_h(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e1201 == RSMSS_H_NONE) {
                return RsmssResult {metal::clamp(dV, 0.0, 1.0), 12u};
            }
            if (_e1201 == RSMSS_H_LEFT) {
                return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - py), 1.0 - px), 0.0, 1.0), 12u};
            }
            if (_e1201 == RSMSS_H_RIGHT) {
                return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - py), px), 0.0, 1.0), 12u};
            }
            return RsmssResult {0.0, 12u};
        }
        case 30u: {
            return RsmssResult {0.0, 2u};
        }
        default: {
            break;
        }
    }
    return RsmssResult {1.0, 3u};
}

float rsmss_key(
    uint key_2,
    float dH_1,
    float dV_1,
    float px_1,
    float py_1,
    RsmssSite site_11,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    RsmssResult _e6 = rsmss_key_case(key_2, dH_1, dV_1, px_1, py_1, site_11, umbrage_out, umbrage_fetched, _buffer_sizes);
    return _e6.value;
}

RsmssResult rsmss_case(
    float H_1,
    float V_1,
    float b_1,
    float tH_1,
    float tV_1,
    float dH_2,
    float dV_2,
    float px_2,
    float py_2,
    bool domH_1,
    bool domV_1,
    RsmssSite site_12,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e12 = rsmss_pack(H_1, V_1, b_1, tH_1, tV_1, domH_1, domV_1);
    RsmssResult _e13 = rsmss_key_case(_e12, dH_2, dV_2, px_2, py_2, site_12, umbrage_out, umbrage_fetched, _buffer_sizes);
    return _e13;
}

float rsmss(
    float H_2,
    float V_2,
    float b_2,
    float tH_2,
    float tV_2,
    float dH_3,
    float dV_3,
    float px_3,
    float py_3,
    bool domH_2,
    bool domV_2,
    RsmssSite site_13,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    RsmssResult _e12 = rsmss_case(H_2, V_2, b_2, tH_2, tV_2, dH_3, dV_3, px_3, py_3, domH_2, domV_2, site_13, umbrage_out, umbrage_fetched, _buffer_sizes);
    return _e12.value;
}

struct rsmss_columnsInput {
};
kernel void rsmss_columns(
  metal::uint3 id [[thread_position_in_grid]]
, device type_3& umbrage_out [[user(fake0)]]
, device type_3 const& umbrage_fetched [[user(fake0)]]
, device type_3 const& umbrage_plain [[user(fake0)]]
, constant _mslBufferSizes& _buffer_sizes [[user(fake0)]]
) {
    uint row = id.x;
    uint _e4 = umbrage_plain[0];
    if (row >= _e4) {
        return;
    }
    uint at = 1u + (row * 5u);
    uint _e14 = umbrage_plain[at + 0u];
    uint _e19 = umbrage_plain[at + 1u];
    uint _e25 = umbrage_plain[at + 2u];
    uint _e31 = umbrage_plain[at + 3u];
    uint _e37 = umbrage_plain[at + 4u];
    RsmssResult _e40 = rsmss_key_case(_e14, as_type<float>(_e19), as_type<float>(_e25), as_type<float>(_e31), as_type<float>(_e37), RsmssSite {row}, umbrage_out, umbrage_fetched, _buffer_sizes);
    umbrage_out[(row * 4u) + 0u] = _e40.case_id;
    umbrage_out[(row * 4u) + 1u] = as_type<uint>(_e40.value);
    return;
}
