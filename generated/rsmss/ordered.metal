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

uint rsmss_fetch_d_cb_h(
    RsmssSite site,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site.row * 4u) + 2u];
    umbrage_out[(site.row * 4u) + 2u] = _e15 + 65536u;
    uint _e25 = umbrage_fetched[(site.row * 10u) + 4u];
    return _e25;
}

uint rsmss_fetch_n_top(
    RsmssSite site_1,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_1.row * 4u) + 2u];
    umbrage_out[(site_1.row * 4u) + 2u] = _e15 + 1u;
    uint _e25 = umbrage_fetched[(site_1.row * 10u) + 0u];
    return _e25;
}

uint rsmss_fetch_n_bottom(
    RsmssSite site_2,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_2.row * 4u) + 2u];
    umbrage_out[(site_2.row * 4u) + 2u] = _e15 + 16u;
    uint _e25 = umbrage_fetched[(site_2.row * 10u) + 1u];
    return _e25;
}

uint rsmss_fetch_d_cb_v(
    RsmssSite site_3,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_3.row * 4u) + 2u];
    umbrage_out[(site_3.row * 4u) + 2u] = _e15 + 1048576u;
    uint _e25 = umbrage_fetched[(site_3.row * 10u) + 5u];
    return _e25;
}

uint rsmss_fetch_d_cb_top(
    RsmssSite site_4,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_4.row * 4u) + 2u];
    umbrage_out[(site_4.row * 4u) + 2u] = _e15 + 16777216u;
    uint _e25 = umbrage_fetched[(site_4.row * 10u) + 6u];
    return _e25;
}

uint rsmss_fetch_d_cb_bottom(
    RsmssSite site_5,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_5.row * 4u) + 2u];
    umbrage_out[(site_5.row * 4u) + 2u] = _e15 + 268435456u;
    uint _e25 = umbrage_fetched[(site_5.row * 10u) + 7u];
    return _e25;
}

uint rsmss_fetch_n_right(
    RsmssSite site_6,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_6.row * 4u) + 2u];
    umbrage_out[(site_6.row * 4u) + 2u] = _e15 + 4096u;
    uint _e25 = umbrage_fetched[(site_6.row * 10u) + 3u];
    return _e25;
}

uint rsmss_fetch_n_left(
    RsmssSite site_7,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_7.row * 4u) + 2u];
    umbrage_out[(site_7.row * 4u) + 2u] = _e15 + 256u;
    uint _e25 = umbrage_fetched[(site_7.row * 10u) + 2u];
    return _e25;
}

uint rsmss_fetch_d_cb_left(
    RsmssSite site_8,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_8.row * 4u) + 3u];
    umbrage_out[(site_8.row * 4u) + 3u] = _e15 + 1u;
    uint _e25 = umbrage_fetched[(site_8.row * 10u) + 8u];
    return _e25;
}

uint rsmss_fetch_d_cb_right(
    RsmssSite site_9,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_9.row * 4u) + 3u];
    umbrage_out[(site_9.row * 4u) + 3u] = _e15 + 16u;
    uint _e25 = umbrage_fetched[(site_9.row * 10u) + 9u];
    return _e25;
}

RsmssResult rsmss_key_case(
    uint key,
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
    bool local_4 = {};
    bool local_5 = {};
    bool local_6 = {};
    bool local_7 = {};
    bool local_8 = {};
    bool local_9 = {};
    bool local_10 = {};
    bool local_11 = {};
    bool local_12 = {};
    bool local_13 = {};
    bool local_14 = {};
    bool local_15 = {};
    bool local_16 = {};
    bool local_17 = {};
    bool local_18 = {};
    bool local_19 = {};
    bool local_20 = {};
    bool local_21 = {};
    bool local_22 = {};
    bool local_23 = {};
    bool local_24 = {};
    bool local_25 = {};
    bool local_26 = {};
    bool local_27 = {};
    bool local_28 = {};
    bool local_29 = {};
    bool local_30 = {};
    bool local_31 = {};
    bool local_32 = {};
    bool local_33 = {};
    bool local_34 = {};
    bool local_35 = {};
    bool local_36 = {};
    bool local_37 = {};
    bool local_38 = {};
    bool local_39 = {};
    bool local_40 = {};
    bool local_41 = {};
    bool local_42 = {};
    bool local_43 = {};
    bool local_44 = {};
    bool local_45 = {};
    bool local_46 = {};
    bool local_47 = {};
    bool local_48 = {};
    bool local_49 = {};
    bool local_50 = {};
    bool local_51 = {};
    bool local_52 = {};
    bool local_53 = {};
    bool local_54 = {};
    bool local_55 = {};
    bool local_56 = {};
    bool local_57 = {};
    bool local_58 = {};
    bool local_59 = {};
    bool local_60 = {};
    bool local_61 = {};
    bool local_62 = {};
    bool local_63 = {};
    bool local_64 = {};
    bool local_65 = {};
    bool local_66 = {};
    bool local_67 = {};
    bool local_68 = {};
    bool local_69 = {};
    bool local_70 = {};
    bool local_71 = {};
    bool local_72 = {};
    bool local_73 = {};
    bool local_74 = {};
    bool local_75 = {};
    bool local_76 = {};
    bool local_77 = {};
    bool local_78 = {};
    bool local_79 = {};
    bool local_80 = {};
    bool local_81 = {};
    bool local_82 = {};
    bool local_83 = {};
    bool local_84 = {};
    bool local_85 = {};
    bool local_86 = {};
    bool local_87 = {};
    bool local_88 = {};
    bool local_89 = {};
    bool local_90 = {};
    bool local_91 = {};
    bool local_92 = {};
    bool local_93 = {};
    bool local_94 = {};
    bool local_95 = {};
    bool local_96 = {};
    bool local_97 = {};
    bool local_98 = {};
    bool local_99 = {};
    bool local_100 = {};
    bool local_101 = {};
    bool local_102 = {};
    bool local_103 = {};
    bool local_104 = {};
    bool local_105 = {};
    bool local_106 = {};
    bool local_107 = {};
    bool local_108 = {};
    bool local_109 = {};
    bool local_110 = {};
    bool local_111 = {};
    bool local_112 = {};
    bool local_113 = {};
    bool local_114 = {};
    bool local_115 = {};
    bool local_116 = {};
    bool local_117 = {};
    bool local_118 = {};
    bool local_119 = {};
    bool local_120 = {};
    bool local_121 = {};
    bool local_122 = {};
    bool local_123 = {};
    bool local_124 = {};
    bool local_125 = {};
    bool local_126 = {};
    bool local_127 = {};
    uint H_3 = key & 3u;
    uint V_3 = (key >> 2u) & 3u;
    uint b_3 = (key >> 4u) & 1u;
    uint tH_3 = (key >> 5u) & 3u;
    uint tV_3 = (key >> 7u) & 3u;
    bool domH_3 = ((key >> 9u) & 1u) != 0u;
    bool domV_3 = ((key >> 10u) & 1u) != 0u;
    if (b_3 == RSMSS_B_ENTERING) {
        if (!((tH_3 == RSMSS_TH_DUAL_NEGATIVE))) {
            local_1 = tV_3 == RSMSS_TH_DUAL_NEGATIVE;
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
        return RsmssResult {1.0, 1u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_3 = H_3 == RSMSS_H_LEFT;
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
            local_5 = V_3 == RSMSS_V_BOTTOM;
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
        float F30_ = (V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py);
        return RsmssResult {metal::clamp(F30_, 0.0, 1.0), 26u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_9 = H_3 == RSMSS_H_LEFT;
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
            local_11 = V_3 == RSMSS_V_BOTTOM;
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
        float F29_ = (H_3 == RSMSS_H_LEFT) ? (1.0 - px) : px;
        float F31_ = (H_3 == RSMSS_H_LEFT) ? (dV - px) : ((px + dV) - 1.0);
        return RsmssResult {metal::clamp((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? F29_ : F31_, 0.0, 1.0), 24u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_15 = H_3 == RSMSS_H_LEFT;
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
            local_17 = V_3 == RSMSS_V_BOTTOM;
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
        float F28_ = (V_3 == RSMSS_V_BOTTOM) ? py : (1.0 - py);
        float F30_1 = (V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py);
        return RsmssResult {metal::clamp((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F28_ : F30_1, 0.0, 1.0), 25u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_21 = H_3 == RSMSS_H_LEFT;
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
            local_23 = V_3 == RSMSS_V_BOTTOM;
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
        float F29_1 = (H_3 == RSMSS_H_LEFT) ? (1.0 - px) : px;
        float F31_1 = (H_3 == RSMSS_H_LEFT) ? (dV - px) : ((px + dV) - 1.0);
        float F28_1 = (V_3 == RSMSS_V_BOTTOM) ? py : (1.0 - py);
        float F30_2 = (V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py);
        return RsmssResult {metal::clamp(metal::max((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? F29_1 : F31_1, (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F28_1 : F30_2), 0.0, 1.0), 27u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_26 = H_3 != RSMSS_H_BOTH;
    } else {
        local_26 = false;
    }
    bool _e297 = local_26;
    if (_e297) {
        local_27 = V_3 != RSMSS_V_BOTH;
    } else {
        local_27 = false;
    }
    bool _e303 = local_27;
    if (_e303) {
        local_28 = tH_3 == RSMSS_TH_POSITIVE_NEGATIVE;
    } else {
        local_28 = false;
    }
    bool _e309 = local_28;
    if (_e309) {
        local_29 = tV_3 == RSMSS_TH_DUAL_POSITIVE;
    } else {
        local_29 = false;
    }
    bool _e315 = local_29;
    if (_e315) {
        if (H_3 == RSMSS_H_LEFT) {
            return RsmssResult {metal::clamp(1.0 - px, 0.0, 1.0), 29u};
        }
        if (H_3 == RSMSS_H_RIGHT) {
            return RsmssResult {metal::clamp(px, 0.0, 1.0), 29u};
        }
        return RsmssResult {0.0, 29u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_30 = H_3 != RSMSS_H_BOTH;
    } else {
        local_30 = false;
    }
    bool _e342 = local_30;
    if (_e342) {
        local_31 = V_3 != RSMSS_V_BOTH;
    } else {
        local_31 = false;
    }
    bool _e348 = local_31;
    if (_e348) {
        local_32 = tH_3 == RSMSS_TH_DUAL_POSITIVE;
    } else {
        local_32 = false;
    }
    bool _e354 = local_32;
    if (_e354) {
        local_33 = tV_3 == RSMSS_TH_POSITIVE_NEGATIVE;
    } else {
        local_33 = false;
    }
    bool _e360 = local_33;
    if (_e360) {
        if (V_3 == RSMSS_V_BOTTOM) {
            return RsmssResult {metal::clamp(py, 0.0, 1.0), 28u};
        }
        if (V_3 == RSMSS_V_TOP) {
            return RsmssResult {metal::clamp(1.0 - py, 0.0, 1.0), 28u};
        }
        return RsmssResult {0.0, 28u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_34 = H_3 != RSMSS_H_BOTH;
    } else {
        local_34 = false;
    }
    bool _e387 = local_34;
    if (_e387) {
        local_35 = V_3 != RSMSS_V_BOTH;
    } else {
        local_35 = false;
    }
    bool _e393 = local_35;
    if (_e393) {
        local_36 = H_3 != RSMSS_H_NONE;
    } else {
        local_36 = false;
    }
    bool _e399 = local_36;
    if (_e399) {
        local_37 = V_3 == RSMSS_V_NONE;
    } else {
        local_37 = false;
    }
    bool _e405 = local_37;
    if (_e405) {
        float F31_2 = (H_3 == RSMSS_H_LEFT) ? (dV - px) : ((px + dV) - 1.0);
        return RsmssResult {metal::clamp(F31_2, 0.0, 1.0), 31u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_38 = H_3 != RSMSS_H_BOTH;
    } else {
        local_38 = false;
    }
    bool _e425 = local_38;
    if (_e425) {
        local_39 = V_3 != RSMSS_V_BOTH;
    } else {
        local_39 = false;
    }
    bool _e431 = local_39;
    if (_e431) {
        local_40 = H_3 == RSMSS_H_NONE;
    } else {
        local_40 = false;
    }
    bool _e437 = local_40;
    if (_e437) {
        local_41 = V_3 != RSMSS_V_NONE;
    } else {
        local_41 = false;
    }
    bool _e443 = local_41;
    if (_e443) {
        float F30_3 = (V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py);
        return RsmssResult {metal::clamp(F30_3, 0.0, 1.0), 30u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_43 = H_3 == RSMSS_H_LEFT;
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
            local_45 = V_3 == RSMSS_V_BOTTOM;
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
        float F22_ = (V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH);
        return RsmssResult {metal::clamp(F22_, 0.0, 1.0), 18u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_48 = H_3 == RSMSS_H_BOTH;
    } else {
        local_48 = false;
    }
    bool _e515 = local_48;
    if (_e515) {
        local_49 = V_3 == RSMSS_V_NONE;
    } else {
        local_49 = false;
    }
    bool _e521 = local_49;
    if (_e521) {
        uint _e522 = rsmss_fetch_d_cb_h(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e522 == RSMSS_H_NONE) {
            return RsmssResult {metal::clamp(dV, 0.0, 1.0), 13u};
        }
        if (_e522 == RSMSS_H_LEFT) {
            float A_h = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - px) : (dV - px);
            return RsmssResult {metal::clamp(A_h, 0.0, 1.0), 13u};
        }
        if (_e522 == RSMSS_H_RIGHT) {
            float B_h = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? px : ((dV + px) - 1.0);
            return RsmssResult {metal::clamp(B_h, 0.0, 1.0), 13u};
        }
        return RsmssResult {0.0, 13u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_51 = H_3 == RSMSS_H_LEFT;
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
            local_53 = V_3 == RSMSS_V_BOTTOM;
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
        float u = (H_3 == RSMSS_H_LEFT) ? px : (1.0 - px);
        float F23_ = (H_3 == RSMSS_H_LEFT) ? ((1.0 + px) - dV) : ((2.0 - px) - dV);
        return RsmssResult {metal::clamp((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? u : F23_, 0.0, 1.0), 16u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_57 = H_3 == RSMSS_H_LEFT;
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
            local_59 = V_3 == RSMSS_V_BOTTOM;
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
        float F20_ = (V_3 == RSMSS_V_BOTTOM) ? (1.0 - py) : py;
        float F22_1 = (V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH);
        return RsmssResult {metal::clamp((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F20_ : F22_1, 0.0, 1.0), 17u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_63 = H_3 == RSMSS_H_LEFT;
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
            local_65 = V_3 == RSMSS_V_BOTTOM;
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
        float u_1 = (H_3 == RSMSS_H_LEFT) ? px : (1.0 - px);
        float F23_1 = (H_3 == RSMSS_H_LEFT) ? ((1.0 + px) - dV) : ((2.0 - px) - dV);
        float F20_1 = (V_3 == RSMSS_V_BOTTOM) ? (1.0 - py) : py;
        float F22_2 = (V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH);
        return RsmssResult {metal::clamp(metal::min((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? u_1 : F23_1, (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F20_1 : F22_2), 0.0, 1.0), 19u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_68 = H_3 != RSMSS_H_BOTH;
    } else {
        local_68 = false;
    }
    bool _e760 = local_68;
    if (_e760) {
        local_69 = V_3 != RSMSS_V_BOTH;
    } else {
        local_69 = false;
    }
    bool _e766 = local_69;
    if (_e766) {
        local_70 = tH_3 == RSMSS_TH_POSITIVE_NEGATIVE;
    } else {
        local_70 = false;
    }
    bool _e772 = local_70;
    if (_e772) {
        local_71 = tV_3 == RSMSS_TH_DUAL_POSITIVE;
    } else {
        local_71 = false;
    }
    bool _e778 = local_71;
    if (_e778) {
        if (H_3 == RSMSS_H_LEFT) {
            return RsmssResult {metal::clamp(px, 0.0, 1.0), 21u};
        }
        if (H_3 == RSMSS_H_RIGHT) {
            return RsmssResult {metal::clamp(1.0 - px, 0.0, 1.0), 21u};
        }
        return RsmssResult {1.0, 21u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_72 = H_3 != RSMSS_H_BOTH;
    } else {
        local_72 = false;
    }
    bool _e805 = local_72;
    if (_e805) {
        local_73 = V_3 != RSMSS_V_BOTH;
    } else {
        local_73 = false;
    }
    bool _e811 = local_73;
    if (_e811) {
        local_74 = tH_3 == RSMSS_TH_DUAL_POSITIVE;
    } else {
        local_74 = false;
    }
    bool _e817 = local_74;
    if (_e817) {
        local_75 = tV_3 == RSMSS_TH_POSITIVE_NEGATIVE;
    } else {
        local_75 = false;
    }
    bool _e823 = local_75;
    if (_e823) {
        if (V_3 == RSMSS_V_BOTTOM) {
            return RsmssResult {metal::clamp(1.0 - py, 0.0, 1.0), 20u};
        }
        if (V_3 == RSMSS_V_TOP) {
            return RsmssResult {metal::clamp(py, 0.0, 1.0), 20u};
        }
        return RsmssResult {1.0, 20u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_76 = H_3 != RSMSS_H_BOTH;
    } else {
        local_76 = false;
    }
    bool _e850 = local_76;
    if (_e850) {
        local_77 = V_3 != RSMSS_V_BOTH;
    } else {
        local_77 = false;
    }
    bool _e856 = local_77;
    if (_e856) {
        local_78 = H_3 != RSMSS_H_NONE;
    } else {
        local_78 = false;
    }
    bool _e862 = local_78;
    if (_e862) {
        local_79 = V_3 == RSMSS_V_NONE;
    } else {
        local_79 = false;
    }
    bool _e868 = local_79;
    if (_e868) {
        float F23_2 = (H_3 == RSMSS_H_LEFT) ? ((1.0 + px) - dV) : ((2.0 - px) - dV);
        return RsmssResult {metal::clamp(F23_2, 0.0, 1.0), 23u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_80 = H_3 != RSMSS_H_BOTH;
    } else {
        local_80 = false;
    }
    bool _e890 = local_80;
    if (_e890) {
        local_81 = V_3 != RSMSS_V_BOTH;
    } else {
        local_81 = false;
    }
    bool _e896 = local_81;
    if (_e896) {
        local_82 = H_3 == RSMSS_H_NONE;
    } else {
        local_82 = false;
    }
    bool _e902 = local_82;
    if (_e902) {
        local_83 = V_3 != RSMSS_V_NONE;
    } else {
        local_83 = false;
    }
    bool _e908 = local_83;
    if (_e908) {
        float F22_3 = (V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH);
        return RsmssResult {metal::clamp(F22_3, 0.0, 1.0), 22u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_84 = H_3 == RSMSS_H_BOTH;
    } else {
        local_84 = false;
    }
    bool _e930 = local_84;
    if (_e930) {
        local_85 = V_3 == RSMSS_V_NONE;
    } else {
        local_85 = false;
    }
    bool _e936 = local_85;
    if (_e936) {
        local_86 = tV_3 == RSMSS_TH_DUAL_POSITIVE;
    } else {
        local_86 = false;
    }
    bool _e942 = local_86;
    if (_e942) {
        uint _e943 = rsmss_fetch_n_top(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e943 == RSMSS_H_BOTH) {
            uint _e946 = rsmss_fetch_n_bottom(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e946 == RSMSS_H_BOTH) {
                return RsmssResult {0.0, 4u};
            }
            if (_e946 == RSMSS_H_LEFT) {
                return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 4u};
            }
            if (_e946 == RSMSS_H_RIGHT) {
                return RsmssResult {metal::clamp(py - px, 0.0, 1.0), 4u};
            }
            return RsmssResult {1.0, 4u};
        }
        uint _e973 = rsmss_fetch_n_bottom(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e973 == RSMSS_H_LEFT) {
            return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 4u};
        }
        if (_e973 == RSMSS_H_RIGHT) {
            return RsmssResult {metal::clamp(py - px, 0.0, 1.0), 4u};
        }
        if (_e943 == RSMSS_H_LEFT) {
            return RsmssResult {metal::clamp(px - py, 0.0, 1.0), 4u};
        }
        if (_e943 == RSMSS_H_RIGHT) {
            return RsmssResult {metal::clamp((1.0 - px) - py, 0.0, 1.0), 4u};
        }
        return RsmssResult {1.0, 4u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_87 = H_3 == RSMSS_H_BOTH;
    } else {
        local_87 = false;
    }
    bool _e1020 = local_87;
    if (_e1020) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_89 = V_3 == RSMSS_V_BOTTOM;
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
        local_90 = tV_3 == RSMSS_TH_DUAL_POSITIVE;
    } else {
        local_90 = false;
    }
    bool _e1039 = local_90;
    if (_e1039) {
        if (V_3 == RSMSS_V_TOP) {
            uint _e1042 = rsmss_fetch_n_bottom(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e1042 == RSMSS_H_BOTH) {
                return RsmssResult {metal::clamp(metal::min(metal::min((1.0 + px) - dV, (2.0 - px) - dV), py), 0.0, 1.0), 5u};
            }
            if (_e1042 == RSMSS_H_LEFT) {
                return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 5u};
            }
            if (_e1042 == RSMSS_H_RIGHT) {
                return RsmssResult {metal::clamp(py - px, 0.0, 1.0), 5u};
            }
            return RsmssResult {1.0, 5u};
        }
        uint _e1079 = rsmss_fetch_n_top(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e1079 == RSMSS_H_BOTH) {
            return RsmssResult {metal::clamp(metal::min(metal::min((1.0 + px) - dV, (2.0 - px) - dV), 1.0 - py), 0.0, 1.0), 5u};
        }
        if (_e1079 == RSMSS_H_LEFT) {
            return RsmssResult {metal::clamp(px - py, 0.0, 1.0), 5u};
        }
        if (_e1079 == RSMSS_H_RIGHT) {
            return RsmssResult {metal::clamp((1.0 - px) - py, 0.0, 1.0), 5u};
        }
        return RsmssResult {1.0, 5u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_91 = H_3 == RSMSS_H_BOTH;
    } else {
        local_91 = false;
    }
    bool _e1125 = local_91;
    if (_e1125) {
        local_92 = V_3 == RSMSS_V_BOTH;
    } else {
        local_92 = false;
    }
    bool _e1131 = local_92;
    if (_e1131) {
        return RsmssResult {0.0, 2u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_93 = H_3 == RSMSS_H_BOTH;
    } else {
        local_93 = false;
    }
    bool _e1142 = local_93;
    if (_e1142) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_95 = V_3 == RSMSS_V_BOTTOM;
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
        local_96 = tV_3 == RSMSS_TH_POSITIVE_NEGATIVE;
    } else {
        local_96 = false;
    }
    bool _e1161 = local_96;
    if (_e1161) {
        uint _e1162 = rsmss_fetch_d_cb_h(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e1162 == RSMSS_H_NONE) {
            return RsmssResult {metal::clamp(1.0 - dV, 0.0, 1.0), 8u};
        }
        if (_e1162 == RSMSS_H_RIGHT) {
            float w = (V_3 == RSMSS_V_TOP) ? py : (1.0 - py);
            return RsmssResult {metal::clamp(metal::min(w, (2.0 - px) - dV), 0.0, 1.0), 8u};
        }
        if (_e1162 == RSMSS_H_LEFT) {
            float w_1 = (V_3 == RSMSS_V_TOP) ? py : (1.0 - py);
            return RsmssResult {metal::clamp(metal::min(w_1, (1.0 + px) - dV), 0.0, 1.0), 8u};
        }
        return RsmssResult {1.0, 8u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_97 = H_3 == RSMSS_H_BOTH;
    } else {
        local_97 = false;
    }
    bool _e1214 = local_97;
    if (_e1214) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_99 = V_3 == RSMSS_V_BOTTOM;
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
        if (V_3 == RSMSS_V_TOP) {
            uint _e1230 = rsmss_fetch_n_bottom(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e1230 == RSMSS_H_NONE) {
                return RsmssResult {metal::clamp(dV, 0.0, 1.0), 12u};
            }
            if (_e1230 == RSMSS_H_RIGHT) {
                float B_h_1 = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? px : ((dV + px) - 1.0);
                return RsmssResult {metal::clamp(metal::max(1.0 - py, B_h_1), 0.0, 1.0), 12u};
            }
            if (_e1230 == RSMSS_H_LEFT) {
                float A_h_1 = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - px) : (dV - px);
                return RsmssResult {metal::clamp(metal::max(1.0 - py, A_h_1), 0.0, 1.0), 12u};
            }
            uint _e1270 = rsmss_fetch_d_cb_h(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e1270 == RSMSS_H_NONE) {
                return RsmssResult {metal::clamp(dV, 0.0, 1.0), 12u};
            }
            if (_e1270 == RSMSS_H_LEFT) {
                return RsmssResult {metal::clamp(metal::max(1.0 - py, 1.0 - px), 0.0, 1.0), 12u};
            }
            if (_e1270 == RSMSS_H_RIGHT) {
                return RsmssResult {metal::clamp(metal::max(1.0 - py, px), 0.0, 1.0), 12u};
            }
            return RsmssResult {0.0, 12u};
        }
        uint _e1303 = rsmss_fetch_n_top(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e1303 == RSMSS_H_NONE) {
            return RsmssResult {metal::clamp(dV, 0.0, 1.0), 12u};
        }
        if (_e1303 == RSMSS_H_RIGHT) {
            float B_h_2 = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? px : ((dV + px) - 1.0);
            return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - py), B_h_2), 0.0, 1.0), 12u};
        }
        if (_e1303 == RSMSS_H_LEFT) {
            float A_h_2 = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - px) : (dV - px);
            return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - py), A_h_2), 0.0, 1.0), 12u};
        }
        uint _e1347 = rsmss_fetch_d_cb_h(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e1347 == RSMSS_H_NONE) {
            return RsmssResult {metal::clamp(dV, 0.0, 1.0), 12u};
        }
        if (_e1347 == RSMSS_H_LEFT) {
            return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - py), 1.0 - px), 0.0, 1.0), 12u};
        }
        if (_e1347 == RSMSS_H_RIGHT) {
            return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - py), px), 0.0, 1.0), 12u};
        }
        return RsmssResult {0.0, 12u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_100 = V_3 == RSMSS_V_BOTH;
    } else {
        local_100 = false;
    }
    bool _e1391 = local_100;
    if (_e1391) {
        local_101 = H_3 == RSMSS_H_NONE;
    } else {
        local_101 = false;
    }
    bool _e1397 = local_101;
    if (_e1397) {
        uint _e1398 = rsmss_fetch_d_cb_v(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e1398 == RSMSS_V_NONE) {
            return RsmssResult {metal::clamp(dH, 0.0, 1.0), 15u};
        }
        if (_e1398 == RSMSS_V_TOP) {
            float A_v = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - py) : (dH - py);
            return RsmssResult {metal::clamp(A_v, 0.0, 1.0), 15u};
        }
        if (_e1398 == RSMSS_V_BOTTOM) {
            float B_v = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? py : ((dH + py) - 1.0);
            return RsmssResult {metal::clamp(B_v, 0.0, 1.0), 15u};
        }
        return RsmssResult {0.0, 15u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_102 = H_3 == RSMSS_H_BOTH;
    } else {
        local_102 = false;
    }
    bool _e1442 = local_102;
    if (_e1442) {
        local_103 = V_3 == RSMSS_V_NONE;
    } else {
        local_103 = false;
    }
    bool _e1448 = local_103;
    if (_e1448) {
        local_104 = tV_3 == RSMSS_TH_POSITIVE_NEGATIVE;
    } else {
        local_104 = false;
    }
    bool _e1454 = local_104;
    if (_e1454) {
        uint _e1455 = rsmss_fetch_d_cb_top(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e1455 == RSMSS_H_NONE) {
            return RsmssResult {metal::clamp(1.0 - dV, 0.0, 1.0), 9u};
        }
        uint _e1465 = rsmss_fetch_d_cb_bottom(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e1465 == RSMSS_H_NONE) {
            return RsmssResult {metal::clamp(1.0 - dV, 0.0, 1.0), 9u};
        }
        if (!((_e1455 == RSMSS_H_LEFT))) {
            local_105 = _e1465 == RSMSS_H_LEFT;
        } else {
            local_105 = true;
        }
        bool _e1483 = local_105;
        if (_e1483) {
            return RsmssResult {metal::clamp((1.0 + px) - dV, 0.0, 1.0), 9u};
        }
        if (!((_e1455 == RSMSS_H_RIGHT))) {
            local_106 = _e1465 == RSMSS_H_RIGHT;
        } else {
            local_106 = true;
        }
        bool _e1500 = local_106;
        if (_e1500) {
            return RsmssResult {metal::clamp((2.0 - px) - dV, 0.0, 1.0), 9u};
        }
        return RsmssResult {1.0, 9u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_107 = V_3 == RSMSS_V_BOTH;
    } else {
        local_107 = false;
    }
    bool _e1519 = local_107;
    if (_e1519) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_109 = H_3 == RSMSS_H_LEFT;
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
        if (H_3 == RSMSS_H_LEFT) {
            uint _e1535 = rsmss_fetch_n_right(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e1535 == RSMSS_V_NONE) {
                return RsmssResult {metal::clamp(dH, 0.0, 1.0), 14u};
            }
            if (_e1535 == RSMSS_V_BOTTOM) {
                float B_v_1 = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? py : ((dH + py) - 1.0);
                return RsmssResult {metal::clamp(metal::max(1.0 - px, B_v_1), 0.0, 1.0), 14u};
            }
            if (_e1535 == RSMSS_V_TOP) {
                float A_v_1 = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - py) : (dH - py);
                return RsmssResult {metal::clamp(metal::max(1.0 - px, A_v_1), 0.0, 1.0), 14u};
            }
            uint _e1575 = rsmss_fetch_d_cb_v(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e1575 == RSMSS_V_NONE) {
                return RsmssResult {metal::clamp(dH, 0.0, 1.0), 14u};
            }
            if (_e1575 == RSMSS_V_TOP) {
                return RsmssResult {metal::clamp(metal::max(1.0 - px, 1.0 - py), 0.0, 1.0), 14u};
            }
            if (_e1575 == RSMSS_V_BOTTOM) {
                return RsmssResult {metal::clamp(metal::max(1.0 - px, py), 0.0, 1.0), 14u};
            }
            return RsmssResult {0.0, 14u};
        }
        uint _e1608 = rsmss_fetch_n_left(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e1608 == RSMSS_V_NONE) {
            return RsmssResult {metal::clamp(dH, 0.0, 1.0), 14u};
        }
        if (_e1608 == RSMSS_V_BOTTOM) {
            float B_v_2 = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? py : ((dH + py) - 1.0);
            return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - px), B_v_2), 0.0, 1.0), 14u};
        }
        if (_e1608 == RSMSS_V_TOP) {
            float A_v_2 = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - py) : (dH - py);
            return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - px), A_v_2), 0.0, 1.0), 14u};
        }
        uint _e1652 = rsmss_fetch_d_cb_v(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e1652 == RSMSS_V_NONE) {
            return RsmssResult {metal::clamp(dH, 0.0, 1.0), 14u};
        }
        if (_e1652 == RSMSS_V_TOP) {
            return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - px), 1.0 - py), 0.0, 1.0), 14u};
        }
        if (_e1652 == RSMSS_V_BOTTOM) {
            return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - px), py), 0.0, 1.0), 14u};
        }
        return RsmssResult {0.0, 14u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_110 = V_3 == RSMSS_V_BOTH;
    } else {
        local_110 = false;
    }
    bool _e1696 = local_110;
    if (_e1696) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_112 = H_3 == RSMSS_H_LEFT;
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
        local_113 = tH_3 == RSMSS_TH_DUAL_POSITIVE;
    } else {
        local_113 = false;
    }
    bool _e1715 = local_113;
    if (_e1715) {
        if (H_3 == RSMSS_H_LEFT) {
            uint _e1718 = rsmss_fetch_n_right(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e1718 == RSMSS_V_BOTH) {
                return RsmssResult {metal::clamp(metal::min(metal::min((1.0 + py) - dH, (2.0 - py) - dH), px), 0.0, 1.0), 7u};
            }
            if (_e1718 == RSMSS_V_TOP) {
                return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 7u};
            }
            if (_e1718 == RSMSS_V_BOTTOM) {
                return RsmssResult {metal::clamp(px - py, 0.0, 1.0), 7u};
            }
            return RsmssResult {1.0, 7u};
        }
        uint _e1755 = rsmss_fetch_n_left(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e1755 == RSMSS_V_BOTH) {
            return RsmssResult {metal::clamp(metal::min(metal::min((1.0 + py) - dH, (2.0 - py) - dH), 1.0 - px), 0.0, 1.0), 7u};
        }
        if (_e1755 == RSMSS_V_TOP) {
            return RsmssResult {metal::clamp(py - px, 0.0, 1.0), 7u};
        }
        if (_e1755 == RSMSS_V_BOTTOM) {
            return RsmssResult {metal::clamp((1.0 - px) - py, 0.0, 1.0), 7u};
        }
        return RsmssResult {1.0, 7u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_114 = V_3 == RSMSS_V_BOTH;
    } else {
        local_114 = false;
    }
    bool _e1801 = local_114;
    if (_e1801) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_116 = H_3 == RSMSS_H_LEFT;
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
        local_117 = tH_3 == RSMSS_TH_POSITIVE_NEGATIVE;
    } else {
        local_117 = false;
    }
    bool _e1820 = local_117;
    if (_e1820) {
        uint _e1821 = rsmss_fetch_d_cb_v(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e1821 == RSMSS_V_NONE) {
            return RsmssResult {metal::clamp(1.0 - dH, 0.0, 1.0), 10u};
        }
        if (_e1821 == RSMSS_V_TOP) {
            float u_2 = (H_3 == RSMSS_H_LEFT) ? px : (1.0 - px);
            return RsmssResult {metal::clamp(metal::min(u_2, (1.0 + py) - dH), 0.0, 1.0), 10u};
        }
        if (_e1821 == RSMSS_V_BOTTOM) {
            float u_3 = (H_3 == RSMSS_H_LEFT) ? px : (1.0 - px);
            return RsmssResult {metal::clamp(metal::min(u_3, (2.0 - py) - dH), 0.0, 1.0), 10u};
        }
        return RsmssResult {1.0, 10u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_118 = H_3 == RSMSS_H_BOTH;
    } else {
        local_118 = false;
    }
    bool _e1873 = local_118;
    if (_e1873) {
        local_119 = V_3 == RSMSS_V_BOTH;
    } else {
        local_119 = false;
    }
    bool _e1879 = local_119;
    if (_e1879) {
        return RsmssResult {1.0, 3u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_120 = V_3 == RSMSS_V_BOTH;
    } else {
        local_120 = false;
    }
    bool _e1890 = local_120;
    if (_e1890) {
        local_121 = H_3 == RSMSS_H_NONE;
    } else {
        local_121 = false;
    }
    bool _e1896 = local_121;
    if (_e1896) {
        local_122 = tH_3 == RSMSS_TH_POSITIVE_NEGATIVE;
    } else {
        local_122 = false;
    }
    bool _e1902 = local_122;
    if (_e1902) {
        uint _e1903 = rsmss_fetch_d_cb_left(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e1903 == RSMSS_V_NONE) {
            return RsmssResult {metal::clamp(1.0 - dH, 0.0, 1.0), 11u};
        }
        uint _e1913 = rsmss_fetch_d_cb_right(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e1913 == RSMSS_V_NONE) {
            return RsmssResult {metal::clamp(1.0 - dH, 0.0, 1.0), 11u};
        }
        if (!((_e1903 == RSMSS_V_TOP))) {
            local_123 = _e1913 == RSMSS_V_TOP;
        } else {
            local_123 = true;
        }
        bool _e1931 = local_123;
        if (_e1931) {
            return RsmssResult {metal::clamp((1.0 + py) - dH, 0.0, 1.0), 11u};
        }
        if (!((_e1903 == RSMSS_V_BOTTOM))) {
            local_124 = _e1913 == RSMSS_V_BOTTOM;
        } else {
            local_124 = true;
        }
        bool _e1948 = local_124;
        if (_e1948) {
            return RsmssResult {metal::clamp((2.0 - py) - dH, 0.0, 1.0), 11u};
        }
        return RsmssResult {1.0, 11u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_125 = V_3 == RSMSS_V_BOTH;
    } else {
        local_125 = false;
    }
    bool _e1967 = local_125;
    if (_e1967) {
        local_126 = H_3 == RSMSS_H_NONE;
    } else {
        local_126 = false;
    }
    bool _e1973 = local_126;
    if (_e1973) {
        local_127 = tH_3 == RSMSS_TH_DUAL_POSITIVE;
    } else {
        local_127 = false;
    }
    bool _e1979 = local_127;
    if (_e1979) {
        uint _e1980 = rsmss_fetch_n_left(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e1980 == RSMSS_V_BOTH) {
            uint _e1983 = rsmss_fetch_n_right(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e1983 == RSMSS_V_BOTH) {
                return RsmssResult {0.0, 6u};
            }
            if (_e1983 == RSMSS_V_TOP) {
                return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 6u};
            }
            if (_e1983 == RSMSS_V_BOTTOM) {
                return RsmssResult {metal::clamp(px - py, 0.0, 1.0), 6u};
            }
            return RsmssResult {1.0, 6u};
        }
        uint _e2010 = rsmss_fetch_n_right(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e2010 == RSMSS_V_TOP) {
            return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 6u};
        }
        if (_e1980 == RSMSS_V_TOP) {
            return RsmssResult {metal::clamp(py - px, 0.0, 1.0), 6u};
        }
        if (_e2010 == RSMSS_V_BOTTOM) {
            return RsmssResult {metal::clamp(px - py, 0.0, 1.0), 6u};
        }
        if (_e1980 == RSMSS_V_BOTTOM) {
            return RsmssResult {metal::clamp((1.0 - px) - py, 0.0, 1.0), 6u};
        }
        return RsmssResult {1.0, 6u};
    }
    return RsmssResult {metal::clamp((b_3 == RSMSS_B_ENTERING) ? 1.0 : 0.0, 0.0, 1.0), RSMSS_DEFAULT};
}

float rsmss_key(
    uint key_1,
    float dH_1,
    float dV_1,
    float px_1,
    float py_1,
    RsmssSite site_11,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    RsmssResult _e6 = rsmss_key_case(key_1, dH_1, dV_1, px_1, py_1, site_11, umbrage_out, umbrage_fetched, _buffer_sizes);
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
