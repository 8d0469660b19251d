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

uint rsmss_fetch_d_cb_h(RsmssSite site)
{
    uint _e15 = asuint(umbrage_out.Load(((site.row * 4u) + 2u)*4));
    umbrage_out.Store(((site.row * 4u) + 2u)*4, asuint((_e15 + 65536u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site.row * 10u) + 4u)*4));
    return _e25;
}

uint rsmss_fetch_n_top(RsmssSite site_1)
{
    uint _e15 = asuint(umbrage_out.Load(((site_1.row * 4u) + 2u)*4));
    umbrage_out.Store(((site_1.row * 4u) + 2u)*4, asuint((_e15 + 1u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_1.row * 10u) + 0u)*4));
    return _e25;
}

uint rsmss_fetch_n_bottom(RsmssSite site_2)
{
    uint _e15 = asuint(umbrage_out.Load(((site_2.row * 4u) + 2u)*4));
    umbrage_out.Store(((site_2.row * 4u) + 2u)*4, asuint((_e15 + 16u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_2.row * 10u) + 1u)*4));
    return _e25;
}

uint rsmss_fetch_d_cb_v(RsmssSite site_3)
{
    uint _e15 = asuint(umbrage_out.Load(((site_3.row * 4u) + 2u)*4));
    umbrage_out.Store(((site_3.row * 4u) + 2u)*4, asuint((_e15 + 1048576u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_3.row * 10u) + 5u)*4));
    return _e25;
}

uint rsmss_fetch_d_cb_top(RsmssSite site_4)
{
    uint _e15 = asuint(umbrage_out.Load(((site_4.row * 4u) + 2u)*4));
    umbrage_out.Store(((site_4.row * 4u) + 2u)*4, asuint((_e15 + 16777216u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_4.row * 10u) + 6u)*4));
    return _e25;
}

uint rsmss_fetch_d_cb_bottom(RsmssSite site_5)
{
    uint _e15 = asuint(umbrage_out.Load(((site_5.row * 4u) + 2u)*4));
    umbrage_out.Store(((site_5.row * 4u) + 2u)*4, asuint((_e15 + 268435456u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_5.row * 10u) + 7u)*4));
    return _e25;
}

uint rsmss_fetch_n_right(RsmssSite site_6)
{
    uint _e15 = asuint(umbrage_out.Load(((site_6.row * 4u) + 2u)*4));
    umbrage_out.Store(((site_6.row * 4u) + 2u)*4, asuint((_e15 + 4096u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_6.row * 10u) + 3u)*4));
    return _e25;
}

uint rsmss_fetch_n_left(RsmssSite site_7)
{
    uint _e15 = asuint(umbrage_out.Load(((site_7.row * 4u) + 2u)*4));
    umbrage_out.Store(((site_7.row * 4u) + 2u)*4, asuint((_e15 + 256u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_7.row * 10u) + 2u)*4));
    return _e25;
}

uint rsmss_fetch_d_cb_left(RsmssSite site_8)
{
    uint _e15 = asuint(umbrage_out.Load(((site_8.row * 4u) + 3u)*4));
    umbrage_out.Store(((site_8.row * 4u) + 3u)*4, asuint((_e15 + 1u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_8.row * 10u) + 8u)*4));
    return _e25;
}

uint rsmss_fetch_d_cb_right(RsmssSite site_9)
{
    uint _e15 = asuint(umbrage_out.Load(((site_9.row * 4u) + 3u)*4));
    umbrage_out.Store(((site_9.row * 4u) + 3u)*4, asuint((_e15 + 16u)));
    uint _e25 = asuint(umbrage_fetched.Load(((site_9.row * 10u) + 9u)*4));
    return _e25;
}

RsmssResult ConstructRsmssResult(float arg0, uint arg1) {
    RsmssResult ret = (RsmssResult)0;
    ret.value = arg0;
    ret.case_id = arg1;
    return ret;
}

RsmssResult rsmss_key_case(uint key, float dH, float dV, float px, float py, RsmssSite site_10)
{
    bool local = (bool)0;
    bool local_1 = (bool)0;
    bool local_2 = (bool)0;
    bool local_3 = (bool)0;
    bool local_4 = (bool)0;
    bool local_5 = (bool)0;
    bool local_6 = (bool)0;
    bool local_7 = (bool)0;
    bool local_8 = (bool)0;
    bool local_9 = (bool)0;
    bool local_10 = (bool)0;
    bool local_11 = (bool)0;
    bool local_12 = (bool)0;
    bool local_13 = (bool)0;
    bool local_14 = (bool)0;
    bool local_15 = (bool)0;
    bool local_16 = (bool)0;
    bool local_17 = (bool)0;
    bool local_18 = (bool)0;
    bool local_19 = (bool)0;
    bool local_20 = (bool)0;
    bool local_21 = (bool)0;
    bool local_22 = (bool)0;
    bool local_23 = (bool)0;
    bool local_24 = (bool)0;
    bool local_25 = (bool)0;
    bool local_26 = (bool)0;
    bool local_27 = (bool)0;
    bool local_28 = (bool)0;
    bool local_29 = (bool)0;
    bool local_30 = (bool)0;
    bool local_31 = (bool)0;
    bool local_32 = (bool)0;
    bool local_33 = (bool)0;
    bool local_34 = (bool)0;
    bool local_35 = (bool)0;
    bool local_36 = (bool)0;
    bool local_37 = (bool)0;
    bool local_38 = (bool)0;
    bool local_39 = (bool)0;
    bool local_40 = (bool)0;
    bool local_41 = (bool)0;
    bool local_42 = (bool)0;
    bool local_43 = (bool)0;
    bool local_44 = (bool)0;
    bool local_45 = (bool)0;
    bool local_46 = (bool)0;
    bool local_47 = (bool)0;
    bool local_48 = (bool)0;
    bool local_49 = (bool)0;
    bool local_50 = (bool)0;
    bool local_51 = (bool)0;
    bool local_52 = (bool)0;
    bool local_53 = (bool)0;
    bool local_54 = (bool)0;
    bool local_55 = (bool)0;
    bool local_56 = (bool)0;
    bool local_57 = (bool)0;
    bool local_58 = (bool)0;
    bool local_59 = (bool)0;
    bool local_60 = (bool)0;
    bool local_61 = (bool)0;
    bool local_62 = (bool)0;
    bool local_63 = (bool)0;
    bool local_64 = (bool)0;
    bool local_65 = (bool)0;
    bool local_66 = (bool)0;
    bool local_67 = (bool)0;
    bool local_68 = (bool)0;
    bool local_69 = (bool)0;
    bool local_70 = (bool)0;
    bool local_71 = (bool)0;
    bool local_72 = (bool)0;
    bool local_73 = (bool)0;
    bool local_74 = (bool)0;
    bool local_75 = (bool)0;
    bool local_76 = (bool)0;
    bool local_77 = (bool)0;
    bool local_78 = (bool)0;
    bool local_79 = (bool)0;
    bool local_80 = (bool)0;
    bool local_81 = (bool)0;
    bool local_82 = (bool)0;
    bool local_83 = (bool)0;
    bool local_84 = (bool)0;
    bool local_85 = (bool)0;
    bool local_86 = (bool)0;
    bool local_87 = (bool)0;
    bool local_88 = (bool)0;
    bool local_89 = (bool)0;
    bool local_90 = (bool)0;
    bool local_91 = (bool)0;
    bool local_92 = (bool)0;
    bool local_93 = (bool)0;
    bool local_94 = (bool)0;
    bool local_95 = (bool)0;
    bool local_96 = (bool)0;
    bool local_97 = (bool)0;
    bool local_98 = (bool)0;
    bool local_99 = (bool)0;
    bool local_100 = (bool)0;
    bool local_101 = (bool)0;
    bool local_102 = (bool)0;
    bool local_103 = (bool)0;
    bool local_104 = (bool)0;
    bool local_105 = (bool)0;
    bool local_106 = (bool)0;
    bool local_107 = (bool)0;
    bool local_108 = (bool)0;
    bool local_109 = (bool)0;
    bool local_110 = (bool)0;
    bool local_111 = (bool)0;
    bool local_112 = (bool)0;
    bool local_113 = (bool)0;
    bool local_114 = (bool)0;
    bool local_115 = (bool)0;
    bool local_116 = (bool)0;
    bool local_117 = (bool)0;
    bool local_118 = (bool)0;
    bool local_119 = (bool)0;
    bool local_120 = (bool)0;
    bool local_121 = (bool)0;
    bool local_122 = (bool)0;
    bool local_123 = (bool)0;
    bool local_124 = (bool)0;
    bool local_125 = (bool)0;
    bool local_126 = (bool)0;
    bool local_127 = (bool)0;

    uint H_3 = (key & 3u);
    uint V_3 = ((key >> 2u) & 3u);
    uint b_3 = ((key >> 4u) & 1u);
    uint tH_3 = ((key >> 5u) & 3u);
    uint tV_3 = ((key >> 7u) & 3u);
    bool domH_3 = (((key >> 9u) & 1u) != 0u);
    bool domV_3 = (((key >> 10u) & 1u) != 0u);
    if ((b_3 == RSMSS_B_ENTERING)) {
        if (!((tH_3 == RSMSS_TH_DUAL_NEGATIVE))) {
            local_1 = (tV_3 == RSMSS_TH_DUAL_NEGATIVE);
        } else {
            local_1 = true;
        }
        bool _e48 = local_1;
        local = _e48;
    } else {
        local = false;
    }
    bool _e50 = local;
    if (_e50) {
        const RsmssResult rsmssresult = ConstructRsmssResult(1.0, 1u);
        return rsmssresult;
    }
    if ((b_3 == RSMSS_B_EXITING)) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_3 = (H_3 == RSMSS_H_LEFT);
        } else {
            local_3 = true;
        }
        bool _e66 = local_3;
        local_2 = _e66;
    } else {
        local_2 = false;
    }
    bool _e68 = local_2;
    if (_e68) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_5 = (V_3 == RSMSS_V_BOTTOM);
        } else {
            local_5 = true;
        }
        bool _e79 = local_5;
        local_4 = _e79;
    } else {
        local_4 = false;
    }
    bool _e81 = local_4;
    if (_e81) {
        local_6 = !(domH_3);
    } else {
        local_6 = false;
    }
    bool _e86 = local_6;
    if (_e86) {
        local_7 = !(domV_3);
    } else {
        local_7 = false;
    }
    bool _e91 = local_7;
    if (_e91) {
        float F30_ = ((V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py));
        const RsmssResult rsmssresult_1 = ConstructRsmssResult(clamp(F30_, 0.0, 1.0), 26u);
        return rsmssresult_1;
    }
    if ((b_3 == RSMSS_B_EXITING)) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_9 = (H_3 == RSMSS_H_LEFT);
        } else {
            local_9 = true;
        }
        bool _e116 = local_9;
        local_8 = _e116;
    } else {
        local_8 = false;
    }
    bool _e118 = local_8;
    if (_e118) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_11 = (V_3 == RSMSS_V_BOTTOM);
        } else {
            local_11 = true;
        }
        bool _e129 = local_11;
        local_10 = _e129;
    } else {
        local_10 = false;
    }
    bool _e131 = local_10;
    if (_e131) {
        local_12 = domH_3;
    } else {
        local_12 = false;
    }
    bool _e135 = local_12;
    if (_e135) {
        local_13 = !(domV_3);
    } else {
        local_13 = false;
    }
    bool _e140 = local_13;
    if (_e140) {
        float F29_ = ((H_3 == RSMSS_H_LEFT) ? (1.0 - px) : px);
        float F31_ = ((H_3 == RSMSS_H_LEFT) ? (dV - px) : ((px + dV) - 1.0));
        const RsmssResult rsmssresult_2 = ConstructRsmssResult(clamp(((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? F29_ : F31_), 0.0, 1.0), 24u);
        return rsmssresult_2;
    }
    if ((b_3 == RSMSS_B_EXITING)) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_15 = (H_3 == RSMSS_H_LEFT);
        } else {
            local_15 = true;
        }
        bool _e173 = local_15;
        local_14 = _e173;
    } else {
        local_14 = false;
    }
    bool _e175 = local_14;
    if (_e175) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_17 = (V_3 == RSMSS_V_BOTTOM);
        } else {
            local_17 = true;
        }
        bool _e186 = local_17;
        local_16 = _e186;
    } else {
        local_16 = false;
    }
    bool _e188 = local_16;
    if (_e188) {
        local_18 = domV_3;
    } else {
        local_18 = false;
    }
    bool _e192 = local_18;
    if (_e192) {
        local_19 = !(domH_3);
    } else {
        local_19 = false;
    }
    bool _e197 = local_19;
    if (_e197) {
        float F28_ = ((V_3 == RSMSS_V_BOTTOM) ? py : (1.0 - py));
        float F30_1 = ((V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py));
        const RsmssResult rsmssresult_3 = ConstructRsmssResult(clamp(((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F28_ : F30_1), 0.0, 1.0), 25u);
        return rsmssresult_3;
    }
    if ((b_3 == RSMSS_B_EXITING)) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_21 = (H_3 == RSMSS_H_LEFT);
        } else {
            local_21 = true;
        }
        bool _e230 = local_21;
        local_20 = _e230;
    } else {
        local_20 = false;
    }
    bool _e232 = local_20;
    if (_e232) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_23 = (V_3 == RSMSS_V_BOTTOM);
        } else {
            local_23 = true;
        }
        bool _e243 = local_23;
        local_22 = _e243;
    } else {
        local_22 = false;
    }
    bool _e245 = local_22;
    if (_e245) {
        local_24 = domH_3;
    } else {
        local_24 = false;
    }
    bool _e249 = local_24;
    if (_e249) {
        local_25 = domV_3;
    } else {
        local_25 = false;
    }
    bool _e253 = local_25;
    if (_e253) {
        float F29_1 = ((H_3 == RSMSS_H_LEFT) ? (1.0 - px) : px);
        float F31_1 = ((H_3 == RSMSS_H_LEFT) ? (dV - px) : ((px + dV) - 1.0));
        float F28_1 = ((V_3 == RSMSS_V_BOTTOM) ? py : (1.0 - py));
        float F30_2 = ((V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py));
        const RsmssResult rsmssresult_4 = ConstructRsmssResult(clamp(max(((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? F29_1 : F31_1), ((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F28_1 : F30_2)), 0.0, 1.0), 27u);
        return rsmssresult_4;
    }
    if ((b_3 == RSMSS_B_EXITING)) {
        local_26 = (H_3 != RSMSS_H_BOTH);
    } else {
        local_26 = false;
    }
    bool _e297 = local_26;
    if (_e297) {
        local_27 = (V_3 != RSMSS_V_BOTH);
    } else {
        local_27 = false;
    }
    bool _e303 = local_27;
    if (_e303) {
        local_28 = (tH_3 == RSMSS_TH_POSITIVE_NEGATIVE);
    } else {
        local_28 = false;
    }
    bool _e309 = local_28;
    if (_e309) {
        local_29 = (tV_3 == RSMSS_TH_DUAL_POSITIVE);
    } else {
        local_29 = false;
    }
    bool _e315 = local_29;
    if (_e315) {
        if ((H_3 == RSMSS_H_LEFT)) {
            const RsmssResult rsmssresult_5 = ConstructRsmssResult(clamp((1.0 - px), 0.0, 1.0), 29u);
            return rsmssresult_5;
        }
        if ((H_3 == RSMSS_H_RIGHT)) {
            const RsmssResult rsmssresult_6 = ConstructRsmssResult(clamp(px, 0.0, 1.0), 29u);
            return rsmssresult_6;
        }
        const RsmssResult rsmssresult_7 = ConstructRsmssResult(0.0, 29u);
        return rsmssresult_7;
    }
    if ((b_3 == RSMSS_B_EXITING)) {
        local_30 = (H_3 != RSMSS_H_BOTH);
    } else {
        local_30 = false;
    }
    bool _e342 = local_30;
    if (_e342) {
        local_31 = (V_3 != RSMSS_V_BOTH);
    } else {
        local_31 = false;
    }
    bool _e348 = local_31;
    if (_e348) {
        local_32 = (tH_3 == RSMSS_TH_DUAL_POSITIVE);
    } else {
        local_32 = false;
    }
    bool _e354 = local_32;
    if (_e354) {
        local_33 = (tV_3 == RSMSS_TH_POSITIVE_NEGATIVE);
    } else {
        local_33 = false;
    }
    bool _e360 = local_33;
    if (_e360) {
        if ((V_3 == RSMSS_V_BOTTOM)) {
            const RsmssResult rsmssresult_8 = ConstructRsmssResult(clamp(py, 0.0, 1.0), 28u);
            return rsmssresult_8;
        }
        if ((V_3 == RSMSS_V_TOP)) {
            const RsmssResult rsmssresult_9 = ConstructRsmssResult(clamp((1.0 - py), 0.0, 1.0), 28u);
            return rsmssresult_9;
        }
        const RsmssResult rsmssresult_10 = ConstructRsmssResult(0.0, 28u);
        return rsmssresult_10;
    }
    if ((b_3 == RSMSS_B_EXITING)) {
        local_34 = (H_3 != RSMSS_H_BOTH);
    } else {
        local_34 = false;
    }
    bool _e387 = local_34;
    if (_e387) {
        local_35 = (V_3 != RSMSS_V_BOTH);
    } else {
        local_35 = false;
    }
    bool _e393 = local_35;
    if (_e393) {
        local_36 = (H_3 != RSMSS_H_NONE);
    } else {
        local_36 = false;
    }
    bool _e399 = local_36;
    if (_e399) {
        local_37 = (V_3 == RSMSS_V_NONE);
    } else {
        local_37 = false;
    }
    bool _e405 = local_37;
    if (_e405) {
        float F31_2 = ((H_3 == RSMSS_H_LEFT) ? (dV - px) : ((px + dV) - 1.0));
        const RsmssResult rsmssresult_11 = ConstructRsmssResult(clamp(F31_2, 0.0, 1.0), 31u);
        return rsmssresult_11;
    }
    if ((b_3 == RSMSS_B_EXITING)) {
        local_38 = (H_3 != RSMSS_H_BOTH);
    } else {
        local_38 = false;
    }
    bool _e425 = local_38;
    if (_e425) {
        local_39 = (V_3 != RSMSS_V_BOTH);
    } else {
        local_39 = false;
    }
    bool _e431 = local_39;
    if (_e431) {
        local_40 = (H_3 == RSMSS_H_NONE);
    } else {
        local_40 = false;
    }
    bool _e437 = local_40;
    if (_e437) {
        local_41 = (V_3 != RSMSS_V_NONE);
    } else {
        local_41 = false;
    }
    bool _e443 = local_41;
    if (_e443) {
        float F30_3 = ((V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py));
        const RsmssResult rsmssresult_12 = ConstructRsmssResult(clamp(F30_3, 0.0, 1.0), 30u);
        return rsmssresult_12;
    }
    if ((b_3 == RSMSS_B_ENTERING)) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_43 = (H_3 == RSMSS_H_LEFT);
        } else {
            local_43 = true;
        }
        bool _e468 = local_43;
        local_42 = _e468;
    } else {
        local_42 = false;
    }
    bool _e470 = local_42;
    if (_e470) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_45 = (V_3 == RSMSS_V_BOTTOM);
        } else {
            local_45 = true;
        }
        bool _e481 = local_45;
        local_44 = _e481;
    } else {
        local_44 = false;
    }
    bool _e483 = local_44;
    if (_e483) {
        local_46 = !(domH_3);
    } else {
        local_46 = false;
    }
    bool _e488 = local_46;
    if (_e488) {
        local_47 = !(domV_3);
    } else {
        local_47 = false;
    }
    bool _e493 = local_47;
    if (_e493) {
        float F22_ = ((V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH));
        const RsmssResult rsmssresult_13 = ConstructRsmssResult(clamp(F22_, 0.0, 1.0), 18u);
        return rsmssresult_13;
    }
    if ((b_3 == RSMSS_B_EXITING)) {
        local_48 = (H_3 == RSMSS_H_BOTH);
    } else {
        local_48 = false;
    }
    bool _e515 = local_48;
    if (_e515) {
        local_49 = (V_3 == RSMSS_V_NONE);
    } else {
        local_49 = false;
    }
    bool _e521 = local_49;
    if (_e521) {
        const uint _e522 = rsmss_fetch_d_cb_h(site_10);
        if ((_e522 == RSMSS_H_NONE)) {
            const RsmssResult rsmssresult_14 = ConstructRsmssResult(clamp(dV, 0.0, 1.0), 13u);
            return rsmssresult_14;
        }
        if ((_e522 == RSMSS_H_LEFT)) {
            float A_h = ((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - px) : (dV - px));
            const RsmssResult rsmssresult_15 = ConstructRsmssResult(clamp(A_h, 0.0, 1.0), 13u);
            return rsmssresult_15;
        }
        if ((_e522 == RSMSS_H_RIGHT)) {
            float B_h = ((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? px : ((dV + px) - 1.0));
            const RsmssResult rsmssresult_16 = ConstructRsmssResult(clamp(B_h, 0.0, 1.0), 13u);
            return rsmssresult_16;
        }
        const RsmssResult rsmssresult_17 = ConstructRsmssResult(0.0, 13u);
        return rsmssresult_17;
    }
    if ((b_3 == RSMSS_B_ENTERING)) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_51 = (H_3 == RSMSS_H_LEFT);
        } else {
            local_51 = true;
        }
        bool _e571 = local_51;
        local_50 = _e571;
    } else {
        local_50 = false;
    }
    bool _e573 = local_50;
    if (_e573) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_53 = (V_3 == RSMSS_V_BOTTOM);
        } else {
            local_53 = true;
        }
        bool _e584 = local_53;
        local_52 = _e584;
    } else {
        local_52 = false;
    }
    bool _e586 = local_52;
    if (_e586) {
        local_54 = domH_3;
    } else {
        local_54 = false;
    }
    bool _e590 = local_54;
    if (_e590) {
        local_55 = !(domV_3);
    } else {
        local_55 = false;
    }
    bool _e595 = local_55;
    if (_e595) {
        float u = ((H_3 == RSMSS_H_LEFT) ? px : (1.0 - px));
        float F23_ = ((H_3 == RSMSS_H_LEFT) ? ((1.0 + px) - dV) : ((2.0 - px) - dV));
        const RsmssResult rsmssresult_18 = ConstructRsmssResult(clamp(((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? u : F23_), 0.0, 1.0), 16u);
        return rsmssresult_18;
    }
    if ((b_3 == RSMSS_B_ENTERING)) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_57 = (H_3 == RSMSS_H_LEFT);
        } else {
            local_57 = true;
        }
        bool _e630 = local_57;
        local_56 = _e630;
    } else {
        local_56 = false;
    }
    bool _e632 = local_56;
    if (_e632) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_59 = (V_3 == RSMSS_V_BOTTOM);
        } else {
            local_59 = true;
        }
        bool _e643 = local_59;
        local_58 = _e643;
    } else {
        local_58 = false;
    }
    bool _e645 = local_58;
    if (_e645) {
        local_60 = domV_3;
    } else {
        local_60 = false;
    }
    bool _e649 = local_60;
    if (_e649) {
        local_61 = !(domH_3);
    } else {
        local_61 = false;
    }
    bool _e654 = local_61;
    if (_e654) {
        float F20_ = ((V_3 == RSMSS_V_BOTTOM) ? (1.0 - py) : py);
        float F22_1 = ((V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH));
        const RsmssResult rsmssresult_19 = ConstructRsmssResult(clamp(((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F20_ : F22_1), 0.0, 1.0), 17u);
        return rsmssresult_19;
    }
    if ((b_3 == RSMSS_B_ENTERING)) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_63 = (H_3 == RSMSS_H_LEFT);
        } else {
            local_63 = true;
        }
        bool _e689 = local_63;
        local_62 = _e689;
    } else {
        local_62 = false;
    }
    bool _e691 = local_62;
    if (_e691) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_65 = (V_3 == RSMSS_V_BOTTOM);
        } else {
            local_65 = true;
        }
        bool _e702 = local_65;
        local_64 = _e702;
    } else {
        local_64 = false;
    }
    bool _e704 = local_64;
    if (_e704) {
        local_66 = domH_3;
    } else {
        local_66 = false;
    }
    bool _e708 = local_66;
    if (_e708) {
        local_67 = domV_3;
    } else {
        local_67 = false;
    }
    bool _e712 = local_67;
    if (_e712) {
        float u_1 = ((H_3 == RSMSS_H_LEFT) ? px : (1.0 - px));
        float F23_1 = ((H_3 == RSMSS_H_LEFT) ? ((1.0 + px) - dV) : ((2.0 - px) - dV));
        float F20_1 = ((V_3 == RSMSS_V_BOTTOM) ? (1.0 - py) : py);
        float F22_2 = ((V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH));
        const RsmssResult rsmssresult_20 = ConstructRsmssResult(clamp(min(((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? u_1 : F23_1), ((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F20_1 : F22_2)), 0.0, 1.0), 19u);
        return rsmssresult_20;
    }
    if ((b_3 == RSMSS_B_ENTERING)) {
        local_68 = (H_3 != RSMSS_H_BOTH);
    } else {
        local_68 = false;
    }
    bool _e760 = local_68;
    if (_e760) {
        local_69 = (V_3 != RSMSS_V_BOTH);
    } else {
        local_69 = false;
    }
    bool _e766 = local_69;
    if (_e766) {
        local_70 = (tH_3 == RSMSS_TH_POSITIVE_NEGATIVE);
    } else {
        local_70 = false;
    }
    bool _e772 = local_70;
    if (_e772) {
        local_71 = (tV_3 == RSMSS_TH_DUAL_POSITIVE);
    } else {
        local_71 = false;
    }
    bool _e778 = local_71;
    if (_e778) {
        if ((H_3 == RSMSS_H_LEFT)) {
            const RsmssResult rsmssresult_21 = ConstructRsmssResult(clamp(px, 0.0, 1.0), 21u);
            return rsmssresult_21;
        }
        if ((H_3 == RSMSS_H_RIGHT)) {
            const RsmssResult rsmssresult_22 = ConstructRsmssResult(clamp((1.0 - px), 0.0, 1.0), 21u);
            return rsmssresult_22;
        }
        const RsmssResult rsmssresult_23 = ConstructRsmssResult(1.0, 21u);
        return rsmssresult_23;
    }
    if ((b_3 == RSMSS_B_ENTERING)) {
        local_72 = (H_3 != RSMSS_H_BOTH);
    } else {
        local_72 = false;
    }
    bool _e805 = local_72;
    if (_e805) {
        local_73 = (V_3 != RSMSS_V_BOTH);
    } else {
        local_73 = false;
    }
    bool _e811 = local_73;
    if (_e811) {
        local_74 = (tH_3 == RSMSS_TH_DUAL_POSITIVE);
    } else {
        local_74 = false;
    }
    bool _e817 = local_74;
    if (_e817) {
        local_75 = (tV_3 == RSMSS_TH_POSITIVE_NEGATIVE);
    } else {
        local_75 = false;
    }
    bool _e823 = local_75;
    if (_e823) {
        if ((V_3 == RSMSS_V_BOTTOM)) {
            const RsmssResult rsmssresult_24 = ConstructRsmssResult(clamp((1.0 - py), 0.0, 1.0), 20u);
            return rsmssresult_24;
        }
        if ((V_3 == RSMSS_V_TOP)) {
            const RsmssResult rsmssresult_25 = ConstructRsmssResult(clamp(py, 0.0, 1.0), 20u);
            return rsmssresult_25;
        }
        const RsmssResult rsmssresult_26 = ConstructRsmssResult(1.0, 20u);
        return rsmssresult_26;
    }
    if ((b_3 == RSMSS_B_ENTERING)) {
        local_76 = (H_3 != RSMSS_H_BOTH);
    } else {
        local_76 = false;
    }
    bool _e850 = local_76;
    if (_e850) {
        local_77 = (V_3 != RSMSS_V_BOTH);
    } else {
        local_77 = false;
    }
    bool _e856 = local_77;
    if (_e856) {
        local_78 = (H_3 != RSMSS_H_NONE);
    } else {
        local_78 = false;
    }
    bool _e862 = local_78;
    if (_e862) {
        local_79 = (V_3 == RSMSS_V_NONE);
    } else {
        local_79 = false;
    }
    bool _e868 = local_79;
    if (_e868) {
        float F23_2 = ((H_3 == RSMSS_H_LEFT) ? ((1.0 + px) - dV) : ((2.0 - px) - dV));
        const RsmssResult rsmssresult_27 = ConstructRsmssResult(clamp(F23_2, 0.0, 1.0), 23u);
        return rsmssresult_27;
    }
    if ((b_3 == RSMSS_B_ENTERING)) {
        local_80 = (H_3 != RSMSS_H_BOTH);
    } else {
        local_80 = false;
    }
    bool _e890 = local_80;
    if (_e890) {
        local_81 = (V_3 != RSMSS_V_BOTH);
    } else {
        local_81 = false;
    }
    bool _e896 = local_81;
    if (_e896) {
        local_82 = (H_3 == RSMSS_H_NONE);
    } else {
        local_82 = false;
    }
    bool _e902 = local_82;
    if (_e902) {
        local_83 = (V_3 != RSMSS_V_NONE);
    } else {
        local_83 = false;
    }
    bool _e908 = local_83;
    if (_e908) {
        float F22_3 = ((V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH));
        const RsmssResult rsmssresult_28 = ConstructRsmssResult(clamp(F22_3, 0.0, 1.0), 22u);
        return rsmssresult_28;
    }
    if ((b_3 == RSMSS_B_ENTERING)) {
        local_84 = (H_3 == RSMSS_H_BOTH);
    } else {
        local_84 = false;
    }
    bool _e930 = local_84;
    if (_e930) {
        local_85 = (V_3 == RSMSS_V_NONE);
    } else {
        local_85 = false;
    }
    bool _e936 = local_85;
    if (_e936) {
        local_86 = (tV_3 == RSMSS_TH_DUAL_POSITIVE);
    } else {
        local_86 = false;
    }
    bool _e942 = local_86;
    if (_e942) {
        const uint _e943 = rsmss_fetch_n_top(site_10);
        if ((_e943 == RSMSS_H_BOTH)) {
            const uint _e946 = rsmss_fetch_n_bottom(site_10);
            if ((_e946 == RSMSS_H_BOTH)) {
                const RsmssResult rsmssresult_29 = ConstructRsmssResult(0.0, 4u);
                return rsmssresult_29;
            }
            if ((_e946 == RSMSS_H_LEFT)) {
                const RsmssResult rsmssresult_30 = ConstructRsmssResult(clamp(((px + py) - 1.0), 0.0, 1.0), 4u);
                return rsmssresult_30;
            }
            if ((_e946 == RSMSS_H_RIGHT)) {
                const RsmssResult rsmssresult_31 = ConstructRsmssResult(clamp((py - px), 0.0, 1.0), 4u);
                return rsmssresult_31;
            }
            const RsmssResult rsmssresult_32 = ConstructRsmssResult(1.0, 4u);
            return rsmssresult_32;
        }
        const uint _e973 = rsmss_fetch_n_bottom(site_10);
        if ((_e973 == RSMSS_H_LEFT)) {
            const RsmssResult rsmssresult_33 = ConstructRsmssResult(clamp(((px + py) - 1.0), 0.0, 1.0), 4u);
            return rsmssresult_33;
        }
        if ((_e973 == RSMSS_H_RIGHT)) {
            const RsmssResult rsmssresult_34 = ConstructRsmssResult(clamp((py - px), 0.0, 1.0), 4u);
            return rsmssresult_34;
        }
        if ((_e943 == RSMSS_H_LEFT)) {
            const RsmssResult rsmssresult_35 = ConstructRsmssResult(clamp((px - py), 0.0, 1.0), 4u);
            return rsmssresult_35;
        }
        if ((_e943 == RSMSS_H_RIGHT)) {
            const RsmssResult rsmssresult_36 = ConstructRsmssResult(clamp(((1.0 - px) - py), 0.0, 1.0), 4u);
            return rsmssresult_36;
        }
        const RsmssResult rsmssresult_37 = ConstructRsmssResult(1.0, 4u);
        return rsmssresult_37;
    }
    if ((b_3 == RSMSS_B_ENTERING)) {
        local_87 = (H_3 == RSMSS_H_BOTH);
    } else {
        local_87 = false;
    }
    bool _e1020 = local_87;
    if (_e1020) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_89 = (V_3 == RSMSS_V_BOTTOM);
        } else {
            local_89 = true;
        }
        bool _e1031 = local_89;
        local_88 = _e1031;
    } else {
        local_88 = false;
    }
    bool _e1033 = local_88;
    if (_e1033) {
        local_90 = (tV_3 == RSMSS_TH_DUAL_POSITIVE);
    } else {
        local_90 = false;
    }
    bool _e1039 = local_90;
    if (_e1039) {
        if ((V_3 == RSMSS_V_TOP)) {
            const uint _e1042 = rsmss_fetch_n_bottom(site_10);
            if ((_e1042 == RSMSS_H_BOTH)) {
                const RsmssResult rsmssresult_38 = ConstructRsmssResult(clamp(min(min(((1.0 + px) - dV), ((2.0 - px) - dV)), py), 0.0, 1.0), 5u);
                return rsmssresult_38;
            }
            if ((_e1042 == RSMSS_H_LEFT)) {
                const RsmssResult rsmssresult_39 = ConstructRsmssResult(clamp(((px + py) - 1.0), 0.0, 1.0), 5u);
                return rsmssresult_39;
            }
            if ((_e1042 == RSMSS_H_RIGHT)) {
                const RsmssResult rsmssresult_40 = ConstructRsmssResult(clamp((py - px), 0.0, 1.0), 5u);
                return rsmssresult_40;
            }
            const RsmssResult rsmssresult_41 = ConstructRsmssResult(1.0, 5u);
            return rsmssresult_41;
        }
        const uint _e1079 = rsmss_fetch_n_top(site_10);
        if ((_e1079 == RSMSS_H_BOTH)) {
            const RsmssResult rsmssresult_42 = ConstructRsmssResult(clamp(min(min(((1.0 + px) - dV), ((2.0 - px) - dV)), (1.0 - py)), 0.0, 1.0), 5u);
            return rsmssresult_42;
        }
        if ((_e1079 == RSMSS_H_LEFT)) {
            const RsmssResult rsmssresult_43 = ConstructRsmssResult(clamp((px - py), 0.0, 1.0), 5u);
            return rsmssresult_43;
        }
        if ((_e1079 == RSMSS_H_RIGHT)) {
            const RsmssResult rsmssresult_44 = ConstructRsmssResult(clamp(((1.0 - px) - py), 0.0, 1.0), 5u);
            return rsmssresult_44;
        }
        const RsmssResult rsmssresult_45 = ConstructRsmssResult(1.0, 5u);
        return rsmssresult_45;
    }
    if ((b_3 == RSMSS_B_ENTERING)) {
        local_91 = (H_3 == RSMSS_H_BOTH);
    } else {
        local_91 = false;
    }
    bool _e1125 = local_91;
    if (_e1125) {
        local_92 = (V_3 == RSMSS_V_BOTH);
    } else {
        local_92 = false;
    }
    bool _e1131 = local_92;
    if (_e1131) {
        const RsmssResult rsmssresult_46 = ConstructRsmssResult(0.0, 2u);
        return rsmssresult_46;
    }
    if ((b_3 == RSMSS_B_ENTERING)) {
        local_93 = (H_3 == RSMSS_H_BOTH);
    } else {
        local_93 = false;
    }
    bool _e1142 = local_93;
    if (_e1142) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_95 = (V_3 == RSMSS_V_BOTTOM);
        } else {
            local_95 = true;
        }
        bool _e1153 = local_95;
        local_94 = _e1153;
    } else {
        local_94 = false;
    }
    bool _e1155 = local_94;
    if (_e1155) {
        local_96 = (tV_3 == RSMSS_TH_POSITIVE_NEGATIVE);
    } else {
        local_96 = false;
    }
    bool _e1161 = local_96;
    if (_e1161) {
        const uint _e1162 = rsmss_fetch_d_cb_h(site_10);
        if ((_e1162 == RSMSS_H_NONE)) {
            const RsmssResult rsmssresult_47 = ConstructRsmssResult(clamp((1.0 - dV), 0.0, 1.0), 8u);
            return rsmssresult_47;
        }
        if ((_e1162 == RSMSS_H_RIGHT)) {
            float w = ((V_3 == RSMSS_V_TOP) ? py : (1.0 - py));
            const RsmssResult rsmssresult_48 = ConstructRsmssResult(clamp(min(w, ((2.0 - px) - dV)), 0.0, 1.0), 8u);
            return rsmssresult_48;
        }
        if ((_e1162 == RSMSS_H_LEFT)) {
            float w_1 = ((V_3 == RSMSS_V_TOP) ? py : (1.0 - py));
            const RsmssResult rsmssresult_49 = ConstructRsmssResult(clamp(min(w_1, ((1.0 + px) - dV)), 0.0, 1.0), 8u);
            return rsmssresult_49;
        }
        const RsmssResult rsmssresult_50 = ConstructRsmssResult(1.0, 8u);
        return rsmssresult_50;
    }
    if ((b_3 == RSMSS_B_EXITING)) {
        local_97 = (H_3 == RSMSS_H_BOTH);
    } else {
        local_97 = false;
    }
    bool _e1214 = local_97;
    if (_e1214) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_99 = (V_3 == RSMSS_V_BOTTOM);
        } else {
            local_99 = true;
        }
        bool _e1225 = local_99;
        local_98 = _e1225;
    } else {
        local_98 = false;
    }
    bool _e1227 = local_98;
    if (_e1227) {
        if ((V_3 == RSMSS_V_TOP)) {
            const uint _e1230 = rsmss_fetch_n_bottom(site_10);
            if ((_e1230 == RSMSS_H_NONE)) {
                const RsmssResult rsmssresult_51 = ConstructRsmssResult(clamp(dV, 0.0, 1.0), 12u);
                return rsmssresult_51;
            }
            if ((_e1230 == RSMSS_H_RIGHT)) {
                float B_h_1 = ((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? px : ((dV + px) - 1.0));
                const RsmssResult rsmssresult_52 = ConstructRsmssResult(clamp(max((1.0 - py), B_h_1), 0.0, 1.0), 12u);
                return rsmssresult_52;
            }
            if ((_e1230 == RSMSS_H_LEFT)) {
                float A_h_1 = ((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - px) : (dV - px));
                const RsmssResult rsmssresult_53 = ConstructRsmssResult(clamp(max((1.0 - py), A_h_1), 0.0, 1.0), 12u);
                return rsmssresult_53;
            }
            const uint _e1270 = rsmss_fetch_d_cb_h(site_10);
            if ((_e1270 == RSMSS_H_NONE)) {
                const RsmssResult rsmssresult_54 = ConstructRsmssResult(clamp(dV, 0.0, 1.0), 12u);
                return rsmssresult_54;
            }
            if ((_e1270 == RSMSS_H_LEFT)) {
                const RsmssResult rsmssresult_55 = ConstructRsmssResult(clamp(max((1.0 - py), (1.0 - px)), 0.0, 1.0), 12u);
                return rsmssresult_55;
            }
            if ((_e1270 == RSMSS_H_RIGHT)) {
                const RsmssResult rsmssresult_56 = ConstructRsmssResult(clamp(max((1.0 - py), px), 0.0, 1.0), 12u);
                return rsmssresult_56;
            }
            const RsmssResult rsmssresult_57 = ConstructRsmssResult(0.0, 12u);
            return rsmssresult_57;
        }
        const uint _e1303 = rsmss_fetch_n_top(site_10);
        if ((_e1303 == RSMSS_H_NONE)) {
            const RsmssResult rsmssresult_58 = ConstructRsmssResult(clamp(dV, 0.0, 1.0), 12u);
            return rsmssresult_58;
        }
        if ((_e1303 == RSMSS_H_RIGHT)) {
            float B_h_2 = ((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? px : ((dV + px) - 1.0));
            const RsmssResult rsmssresult_59 = ConstructRsmssResult(clamp(max((1.0 - (1.0 - py)), B_h_2), 0.0, 1.0), 12u);
            return rsmssresult_59;
        }
        if ((_e1303 == RSMSS_H_LEFT)) {
            float A_h_2 = ((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - px) : (dV - px));
            const RsmssResult rsmssresult_60 = ConstructRsmssResult(clamp(max((1.0 - (1.0 - py)), A_h_2), 0.0, 1.0), 12u);
            return rsmssresult_60;
        }
        const uint _e1347 = rsmss_fetch_d_cb_h(site_10);
        if ((_e1347 == RSMSS_H_NONE)) {
            const RsmssResult rsmssresult_61 = ConstructRsmssResult(clamp(dV, 0.0, 1.0), 12u);
            return rsmssresult_61;
        }
        if ((_e1347 == RSMSS_H_LEFT)) {
            const RsmssResult rsmssresult_62 = ConstructRsmssResult(clamp(max((1.0 - (1.0 - py)), (1.0 - px)), 0.0, 1.0), 12u);
            return rsmssresult_62;
        }
        if ((_e1347 == RSMSS_H_RIGHT)) {
            const RsmssResult rsmssresult_63 = ConstructRsmssResult(clamp(max((1.0 - (1.0 - py)), px), 0.0, 1.0), 12u);
            return rsmssresult_63;
        }
        const RsmssResult rsmssresult_64 = ConstructRsmssResult(0.0, 12u);
        return rsmssresult_64;
    }
    if ((b_3 == RSMSS_B_EXITING)) {
        local_100 = (V_3 == RSMSS_V_BOTH);
    } else {
        local_100 = false;
    }
    bool _e1391 = local_100;
    if (_e1391) {
        local_101 = (H_3 == RSMSS_H_NONE);
    } else {
        local_101 = false;
    }
    bool _e1397 = local_101;
    if (_e1397) {
        const uint _e1398 = rsmss_fetch_d_cb_v(site_10);
        if ((_e1398 == RSMSS_V_NONE)) {
            const RsmssResult rsmssresult_65 = ConstructRsmssResult(clamp(dH, 0.0, 1.0), 15u);
            return rsmssresult_65;
        }
        if ((_e1398 == RSMSS_V_TOP)) {
            float A_v = ((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - py) : (dH - py));
            const RsmssResult rsmssresult_66 = ConstructRsmssResult(clamp(A_v, 0.0, 1.0), 15u);
            return rsmssresult_66;
        }
        if ((_e1398 == RSMSS_V_BOTTOM)) {
            float B_v = ((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? py : ((dH + py) - 1.0));
            const RsmssResult rsmssresult_67 = ConstructRsmssResult(clamp(B_v, 0.0, 1.0), 15u);
            return rsmssresult_67;
        }
        const RsmssResult rsmssresult_68 = ConstructRsmssResult(0.0, 15u);
        return rsmssresult_68;
    }
    if ((b_3 == RSMSS_B_ENTERING)) {
        local_102 = (H_3 == RSMSS_H_BOTH);
    } else {
        local_102 = false;
    }
    bool _e1442 = local_102;
    if (_e1442) {
        local_103 = (V_3 == RSMSS_V_NONE);
    } else {
        local_103 = false;
    }
    bool _e1448 = local_103;
    if (_e1448) {
        local_104 = (tV_3 == RSMSS_TH_POSITIVE_NEGATIVE);
    } else {
        local_104 = false;
    }
    bool _e1454 = local_104;
    if (_e1454) {
        const uint _e1455 = rsmss_fetch_d_cb_top(site_10);
        if ((_e1455 == RSMSS_H_NONE)) {
            const RsmssResult rsmssresult_69 = ConstructRsmssResult(clamp((1.0 - dV), 0.0, 1.0), 9u);
            return rsmssresult_69;
        }
        const uint _e1465 = rsmss_fetch_d_cb_bottom(site_10);
        if ((_e1465 == RSMSS_H_NONE)) {
            const RsmssResult rsmssresult_70 = ConstructRsmssResult(clamp((1.0 - dV), 0.0, 1.0), 9u);
            return rsmssresult_70;
        }
        if (!((_e1455 == RSMSS_H_LEFT))) {
            local_105 = (_e1465 == RSMSS_H_LEFT);
        } else {
            local_105 = true;
        }
        bool _e1483 = local_105;
        if (_e1483) {
            const RsmssResult rsmssresult_71 = ConstructRsmssResult(clamp(((1.0 + px) - dV), 0.0, 1.0), 9u);
            return rsmssresult_71;
        }
        if (!((_e1455 == RSMSS_H_RIGHT))) {
            local_106 = (_e1465 == RSMSS_H_RIGHT);
        } else {
            local_106 = true;
        }
        bool _e1500 = local_106;
        if (_e1500) {
            const RsmssResult rsmssresult_72 = ConstructRsmssResult(clamp(((2.0 - px) - dV), 0.0, 1.0), 9u);
            return rsmssresult_72;
        }
        const RsmssResult rsmssresult_73 = ConstructRsmssResult(1.0, 9u);
        return rsmssresult_73;
    }
    if ((b_3 == RSMSS_B_EXITING)) {
        local_107 = (V_3 == RSMSS_V_BOTH);
    } else {
        local_107 = false;
    }
    bool _e1519 = local_107;
    if (_e1519) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_109 = (H_3 == RSMSS_H_LEFT);
        } else {
            local_109 = true;
        }
        bool _e1530 = local_109;
        local_108 = _e1530;
    } else {
        local_108 = false;
    }
    bool _e1532 = local_108;
    if (_e1532) {
        if ((H_3 == RSMSS_H_LEFT)) {
            const uint _e1535 = rsmss_fetch_n_right(site_10);
            if ((_e1535 == RSMSS_V_NONE)) {
                const RsmssResult rsmssresult_74 = ConstructRsmssResult(clamp(dH, 0.0, 1.0), 14u);
                return rsmssresult_74;
            }
            if ((_e1535 == RSMSS_V_BOTTOM)) {
                float B_v_1 = ((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? py : ((dH + py) - 1.0));
                const RsmssResult rsmssresult_75 = ConstructRsmssResult(clamp(max((1.0 - px), B_v_1), 0.0, 1.0), 14u);
                return rsmssresult_75;
            }
            if ((_e1535 == RSMSS_V_TOP)) {
                float A_v_1 = ((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - py) : (dH - py));
                const RsmssResult rsmssresult_76 = ConstructRsmssResult(clamp(max((1.0 - px), A_v_1), 0.0, 1.0), 14u);
                return rsmssresult_76;
            }
            const uint _e1575 = rsmss_fetch_d_cb_v(site_10);
            if ((_e1575 == RSMSS_V_NONE)) {
                const RsmssResult rsmssresult_77 = ConstructRsmssResult(clamp(dH, 0.0, 1.0), 14u);
                return rsmssresult_77;
            }
            if ((_e1575 == RSMSS_V_TOP)) {
                const RsmssResult rsmssresult_78 = ConstructRsmssResult(clamp(max((1.0 - px), (1.0 - py)), 0.0, 1.0), 14u);
                return rsmssresult_78;
            }
            if ((_e1575 == RSMSS_V_BOTTOM)) {
                const RsmssResult rsmssresult_79 = ConstructRsmssResult(clamp(max((1.0 - px), py), 0.0, 1.0), 14u);
                return rsmssresult_79;
            }
            const RsmssResult rsmssresult_80 = ConstructRsmssResult(0.0, 14u);
            return rsmssresult_80;
        }
        const uint _e1608 = rsmss_fetch_n_left(site_10);
        if ((_e1608 == RSMSS_V_NONE)) {
            const RsmssResult rsmssresult_81 = ConstructRsmssResult(clamp(dH, 0.0, 1.0), 14u);
            return rsmssresult_81;
        }
        if ((_e1608 == RSMSS_V_BOTTOM)) {
            float B_v_2 = ((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? py : ((dH + py) - 1.0));
            const RsmssResult rsmssresult_82 = ConstructRsmssResult(clamp(max((1.0 - (1.0 - px)), B_v_2), 0.0, 1.0), 14u);
            return rsmssresult_82;
        }
        if ((_e1608 == RSMSS_V_TOP)) {
            float A_v_2 = ((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - py) : (dH - py));
            const RsmssResult rsmssresult_83 = ConstructRsmssResult(clamp(max((1.0 - (1.0 - px)), A_v_2), 0.0, 1.0), 14u);
            return rsmssresult_83;
        }
        const uint _e1652 = rsmss_fetch_d_cb_v(site_10);
        if ((_e1652 == RSMSS_V_NONE)) {
            const RsmssResult rsmssresult_84 = ConstructRsmssResult(clamp(dH, 0.0, 1.0), 14u);
            return rsmssresult_84;
        }
        if ((_e1652 == RSMSS_V_TOP)) {
            const RsmssResult rsmssresult_85 = ConstructRsmssResult(clamp(max((1.0 - (1.0 - px)), (1.0 - py)), 0.0, 1.0), 14u);
            return rsmssresult_85;
        }
        if ((_e1652 == RSMSS_V_BOTTOM)) {
            const RsmssResult rsmssresult_86 = ConstructRsmssResult(clamp(max((1.0 - (1.0 - px)), py), 0.0, 1.0), 14u);
            return rsmssresult_86;
        }
        const RsmssResult rsmssresult_87 = ConstructRsmssResult(0.0, 14u);
        return rsmssresult_87;
    }
    if ((b_3 == RSMSS_B_ENTERING)) {
        local_110 = (V_3 == RSMSS_V_BOTH);
    } else {
        local_110 = false;
    }
    bool _e1696 = local_110;
    if (_e1696) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_112 = (H_3 == RSMSS_H_LEFT);
        } else {
            local_112 = true;
        }
        bool _e1707 = local_112;
        local_111 = _e1707;
    } else {
        local_111 = false;
    }
    bool _e1709 = local_111;
    if (_e1709) {
        local_113 = (tH_3 == RSMSS_TH_DUAL_POSITIVE);
    } else {
        local_113 = false;
    }
    bool _e1715 = local_113;
    if (_e1715) {
        if ((H_3 == RSMSS_H_LEFT)) {
            const uint _e1718 = rsmss_fetch_n_right(site_10);
            if ((_e1718 == RSMSS_V_BOTH)) {
                const RsmssResult rsmssresult_88 = ConstructRsmssResult(clamp(min(min(((1.0 + py) - dH), ((2.0 - py) - dH)), px), 0.0, 1.0), 7u);
                return rsmssresult_88;
            }
            if ((_e1718 == RSMSS_V_TOP)) {
                const RsmssResult rsmssresult_89 = ConstructRsmssResult(clamp(((px + py) - 1.0), 0.0, 1.0), 7u);
                return rsmssresult_89;
            }
            if ((_e1718 == RSMSS_V_BOTTOM)) {
                const RsmssResult rsmssresult_90 = ConstructRsmssResult(clamp((px - py), 0.0, 1.0), 7u);
                return rsmssresult_90;
            }
            const RsmssResult rsmssresult_91 = ConstructRsmssResult(1.0, 7u);
            return rsmssresult_91;
        }
        const uint _e1755 = rsmss_fetch_n_left(site_10);
        if ((_e1755 == RSMSS_V_BOTH)) {
            const RsmssResult rsmssresult_92 = ConstructRsmssResult(clamp(min(min(((1.0 + py) - dH), ((2.0 - py) - dH)), (1.0 - px)), 0.0, 1.0), 7u);
            return rsmssresult_92;
        }
        if ((_e1755 == RSMSS_V_TOP)) {
            const RsmssResult rsmssresult_93 = ConstructRsmssResult(clamp((py - px), 0.0, 1.0), 7u);
            return rsmssresult_93;
        }
        if ((_e1755 == RSMSS_V_BOTTOM)) {
            const RsmssResult rsmssresult_94 = ConstructRsmssResult(clamp(((1.0 - px) - py), 0.0, 1.0), 7u);
            return rsmssresult_94;
        }
        const RsmssResult rsmssresult_95 = ConstructRsmssResult(1.0, 7u);
        return rsmssresult_95;
    }
    if ((b_3 == RSMSS_B_ENTERING)) {
        local_114 = (V_3 == RSMSS_V_BOTH);
    } else {
        local_114 = false;
    }
    bool _e1801 = local_114;
    if (_e1801) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_116 = (H_3 == RSMSS_H_LEFT);
        } else {
            local_116 = true;
        }
        bool _e1812 = local_116;
        local_115 = _e1812;
    } else {
        local_115 = false;
    }
    bool _e1814 = local_115;
    if (_e1814) {
        local_117 = (tH_3 == RSMSS_TH_POSITIVE_NEGATIVE);
    } else {
        local_117 = false;
    }
    bool _e1820 = local_117;
    if (_e1820) {
        const uint _e1821 = rsmss_fetch_d_cb_v(site_10);
        if ((_e1821 == RSMSS_V_NONE)) {
            const RsmssResult rsmssresult_96 = ConstructRsmssResult(clamp((1.0 - dH), 0.0, 1.0), 10u);
            return rsmssresult_96;
        }
        if ((_e1821 == RSMSS_V_TOP)) {
            float u_2 = ((H_3 == RSMSS_H_LEFT) ? px : (1.0 - px));
            const RsmssResult rsmssresult_97 = ConstructRsmssResult(clamp(min(u_2, ((1.0 + py) - dH)), 0.0, 1.0), 10u);
            return rsmssresult_97;
        }
        if ((_e1821 == RSMSS_V_BOTTOM)) {
            float u_3 = ((H_3 == RSMSS_H_LEFT) ? px : (1.0 - px));
            const RsmssResult rsmssresult_98 = ConstructRsmssResult(clamp(min(u_3, ((2.0 - py) - dH)), 0.0, 1.0), 10u);
            return rsmssresult_98;
        }
        const RsmssResult rsmssresult_99 = ConstructRsmssResult(1.0, 10u);
        return rsmssresult_99;
    }
    if ((b_3 == RSMSS_B_EXITING)) {
        local_118 = (H_3 == RSMSS_H_BOTH);
    } else {
        local_118 = false;
    }
    bool _e1873 = local_118;
    if (_e1873) {
        local_119 = (V_3 == RSMSS_V_BOTH);
    } else {
        local_119 = false;
    }
    bool _e1879 = local_119;
    if (_e1879) {
        const RsmssResult rsmssresult_100 = ConstructRsmssResult(1.0, 3u);
        return rsmssresult_100;
    }
    if ((b_3 == RSMSS_B_ENTERING)) {
        local_120 = (V_3 == RSMSS_V_BOTH);
    } else {
        local_120 = false;
    }
    bool _e1890 = local_120;
    if (_e1890) {
        local_121 = (H_3 == RSMSS_H_NONE);
    } else {
        local_121 = false;
    }
    bool _e1896 = local_121;
    if (_e1896) {
        local_122 = (tH_3 == RSMSS_TH_POSITIVE_NEGATIVE);
    } else {
        local_122 = false;
    }
    bool _e1902 = local_122;
    if (_e1902) {
        const uint _e1903 = rsmss_fetch_d_cb_left(site_10);
        if ((_e1903 == RSMSS_V_NONE)) {
            const RsmssResult rsmssresult_101 = ConstructRsmssResult(clamp((1.0 - dH), 0.0, 1.0), 11u);
            return rsmssresult_101;
        }
        const uint _e1913 = rsmss_fetch_d_cb_right(site_10);
        if ((_e1913 == RSMSS_V_NONE)) {
            const RsmssResult rsmssresult_102 = ConstructRsmssResult(clamp((1.0 - dH), 0.0, 1.0), 11u);
            return rsmssresult_102;
        }
        if (!((_e1903 == RSMSS_V_TOP))) {
            local_123 = (_e1913 == RSMSS_V_TOP);
        } else {
            local_123 = true;
        }
        bool _e1931 = local_123;
        if (_e1931) {
            const RsmssResult rsmssresult_103 = ConstructRsmssResult(clamp(((1.0 + py) - dH), 0.0, 1.0), 11u);
            return rsmssresult_103;
        }
        if (!((_e1903 == RSMSS_V_BOTTOM))) {
            local_124 = (_e1913 == RSMSS_V_BOTTOM);
        } else {
            local_124 = true;
        }
        bool _e1948 = local_124;
        if (_e1948) {
            const RsmssResult rsmssresult_104 = ConstructRsmssResult(clamp(((2.0 - py) - dH), 0.0, 1.0), 11u);
            return rsmssresult_104;
        }
        const RsmssResult rsmssresult_105 = ConstructRsmssResult(1.0, 11u);
        return rsmssresult_105;
    }
    if ((b_3 == RSMSS_B_ENTERING)) {
        local_125 = (V_3 == RSMSS_V_BOTH);
    } else {
        local_125 = false;
    }
    bool _e1967 = local_125;
    if (_e1967) {
        local_126 = (H_3 == RSMSS_H_NONE);
    } else {
        local_126 = false;
    }
    bool _e1973 = local_126;
    if (_e1973) {
        local_127 = (tH_3 == RSMSS_TH_DUAL_POSITIVE);
    } else {
        local_127 = false;
    }
    bool _e1979 = local_127;
    if (_e1979) {
        const uint _e1980 = rsmss_fetch_n_left(site_10);
        if ((_e1980 == RSMSS_V_BOTH)) {
            const uint _e1983 = rsmss_fetch_n_right(site_10);
            if ((_e1983 == RSMSS_V_BOTH)) {
                const RsmssResult rsmssresult_106 = ConstructRsmssResult(0.0, 6u);
                return rsmssresult_106;
            }
            if ((_e1983 == RSMSS_V_TOP)) {
                const RsmssResult rsmssresult_107 = ConstructRsmssResult(clamp(((px + py) - 1.0), 0.0, 1.0), 6u);
                return rsmssresult_107;
            }
            if ((_e1983 == RSMSS_V_BOTTOM)) {
                const RsmssResult rsmssresult_108 = ConstructRsmssResult(clamp((px - py), 0.0, 1.0), 6u);
                return rsmssresult_108;
            }
            const RsmssResult rsmssresult_109 = ConstructRsmssResult(1.0, 6u);
            return rsmssresult_109;
        }
        const uint _e2010 = rsmss_fetch_n_right(site_10);
        if ((_e2010 == RSMSS_V_TOP)) {
            const RsmssResult rsmssresult_110 = ConstructRsmssResult(clamp(((px + py) - 1.0), 0.0, 1.0), 6u);
            return rsmssresult_110;
        }
        if ((_e1980 == RSMSS_V_TOP)) {
            const RsmssResult rsmssresult_111 = ConstructRsmssResult(clamp((py - px), 0.0, 1.0), 6u);
            return rsmssresult_111;
        }
        if ((_e2010 == RSMSS_V_BOTTOM)) {
            const RsmssResult rsmssresult_112 = ConstructRsmssResult(clamp((px - py), 0.0, 1.0), 6u);
            return rsmssresult_112;
        }
        if ((_e1980 == RSMSS_V_BOTTOM)) {
            const RsmssResult rsmssresult_113 = ConstructRsmssResult(clamp(((1.0 - px) - py), 0.0, 1.0), 6u);
            return rsmssresult_113;
        }
        const RsmssResult rsmssresult_114 = ConstructRsmssResult(1.0, 6u);
        return rsmssresult_114;
    }
    const RsmssResult rsmssresult_115 = ConstructRsmssResult(clamp(((b_3 == RSMSS_B_ENTERING) ? 1.0 : 0.0), 0.0, 1.0), RSMSS_DEFAULT);
    return rsmssresult_115;
}

float rsmss_key(uint key_1, float dH_1, float dV_1, float px_1, float py_1, RsmssSite site_11)
{
    const RsmssResult _e6 = rsmss_key_case(key_1, dH_1, dV_1, px_1, py_1, site_11);
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
