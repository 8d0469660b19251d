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

uint rsmss_fetch_n_top(
    RsmssSite site,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site.row * 4u) + 2u];
    umbrage_out[(site.row * 4u) + 2u] = _e15 + 1u;
    uint _e25 = umbrage_fetched[(site.row * 10u) + 0u];
    return _e25;
}

uint rsmss_fetch_n_bottom(
    RsmssSite site_1,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_1.row * 4u) + 2u];
    umbrage_out[(site_1.row * 4u) + 2u] = _e15 + 16u;
    uint _e25 = umbrage_fetched[(site_1.row * 10u) + 1u];
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

uint rsmss_fetch_d_cb_h(
    RsmssSite site_4,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_4.row * 4u) + 2u];
    umbrage_out[(site_4.row * 4u) + 2u] = _e15 + 65536u;
    uint _e25 = umbrage_fetched[(site_4.row * 10u) + 4u];
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

uint rsmss_fetch_d_cb_v(
    RsmssSite site_7,
    device type_3& umbrage_out,
    device type_3 const& umbrage_fetched,
    constant _mslBufferSizes& _buffer_sizes
) {
    uint _e15 = umbrage_out[(site_7.row * 4u) + 2u];
    umbrage_out[(site_7.row * 4u) + 2u] = _e15 + 1048576u;
    uint _e25 = umbrage_fetched[(site_7.row * 10u) + 5u];
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
    if (b_3 == RSMSS_B_ENTERING) {
        local_2 = H_3 == RSMSS_H_BOTH;
    } else {
        local_2 = false;
    }
    bool _e61 = local_2;
    if (_e61) {
        local_3 = V_3 == RSMSS_V_BOTH;
    } else {
        local_3 = false;
    }
    bool _e67 = local_3;
    if (_e67) {
        return RsmssResult {0.0, 2u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_4 = H_3 == RSMSS_H_BOTH;
    } else {
        local_4 = false;
    }
    bool _e78 = local_4;
    if (_e78) {
        local_5 = V_3 == RSMSS_V_BOTH;
    } else {
        local_5 = false;
    }
    bool _e84 = local_5;
    if (_e84) {
        return RsmssResult {1.0, 3u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_6 = H_3 == RSMSS_H_BOTH;
    } else {
        local_6 = false;
    }
    bool _e95 = local_6;
    if (_e95) {
        local_7 = V_3 == RSMSS_V_NONE;
    } else {
        local_7 = false;
    }
    bool _e101 = local_7;
    if (_e101) {
        local_8 = tV_3 == RSMSS_TH_DUAL_POSITIVE;
    } else {
        local_8 = false;
    }
    bool _e107 = local_8;
    if (_e107) {
        uint _e108 = rsmss_fetch_n_top(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e108 == RSMSS_H_BOTH) {
            uint _e111 = rsmss_fetch_n_bottom(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e111 == RSMSS_H_BOTH) {
                return RsmssResult {0.0, 4u};
            }
            if (_e111 == RSMSS_H_LEFT) {
                return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 4u};
            }
            if (_e111 == RSMSS_H_RIGHT) {
                return RsmssResult {metal::clamp(py - px, 0.0, 1.0), 4u};
            }
            return RsmssResult {1.0, 4u};
        }
        uint _e138 = rsmss_fetch_n_bottom(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e138 == RSMSS_H_LEFT) {
            return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 4u};
        }
        if (_e138 == RSMSS_H_RIGHT) {
            return RsmssResult {metal::clamp(py - px, 0.0, 1.0), 4u};
        }
        if (_e108 == RSMSS_H_LEFT) {
            return RsmssResult {metal::clamp(px - py, 0.0, 1.0), 4u};
        }
        if (_e108 == RSMSS_H_RIGHT) {
            return RsmssResult {metal::clamp((1.0 - px) - py, 0.0, 1.0), 4u};
        }
        return RsmssResult {1.0, 4u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_9 = H_3 == RSMSS_H_BOTH;
    } else {
        local_9 = false;
    }
    bool _e185 = local_9;
    if (_e185) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_11 = V_3 == RSMSS_V_BOTTOM;
        } else {
            local_11 = true;
        }
        bool _e196 = local_11;
        local_10 = _e196;
    } else {
        local_10 = false;
    }
    bool _e198 = local_10;
    if (_e198) {
        local_12 = tV_3 == RSMSS_TH_DUAL_POSITIVE;
    } else {
        local_12 = false;
    }
    bool _e204 = local_12;
    if (_e204) {
        if (V_3 == RSMSS_V_TOP) {
            uint _e207 = rsmss_fetch_n_bottom(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e207 == RSMSS_H_BOTH) {
                return RsmssResult {metal::clamp(metal::min(metal::min((1.0 + px) - dV, (2.0 - px) - dV), py), 0.0, 1.0), 5u};
            }
            if (_e207 == RSMSS_H_LEFT) {
                return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 5u};
            }
            if (_e207 == RSMSS_H_RIGHT) {
                return RsmssResult {metal::clamp(py - px, 0.0, 1.0), 5u};
            }
            return RsmssResult {1.0, 5u};
        }
        uint _e244 = rsmss_fetch_n_top(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e244 == RSMSS_H_BOTH) {
            return RsmssResult {metal::clamp(metal::min(metal::min((1.0 + px) - dV, (2.0 - px) - dV), 1.0 - py), 0.0, 1.0), 5u};
        }
        if (_e244 == RSMSS_H_LEFT) {
            return RsmssResult {metal::clamp(px - py, 0.0, 1.0), 5u};
        }
        if (_e244 == RSMSS_H_RIGHT) {
            return RsmssResult {metal::clamp((1.0 - px) - py, 0.0, 1.0), 5u};
        }
        return RsmssResult {1.0, 5u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_13 = V_3 == RSMSS_V_BOTH;
    } else {
        local_13 = false;
    }
    bool _e290 = local_13;
    if (_e290) {
        local_14 = H_3 == RSMSS_H_NONE;
    } else {
        local_14 = false;
    }
    bool _e296 = local_14;
    if (_e296) {
        local_15 = tH_3 == RSMSS_TH_DUAL_POSITIVE;
    } else {
        local_15 = false;
    }
    bool _e302 = local_15;
    if (_e302) {
        uint _e303 = rsmss_fetch_n_left(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e303 == RSMSS_V_BOTH) {
            uint _e306 = rsmss_fetch_n_right(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e306 == RSMSS_V_BOTH) {
                return RsmssResult {0.0, 6u};
            }
            if (_e306 == RSMSS_V_TOP) {
                return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 6u};
            }
            if (_e306 == RSMSS_V_BOTTOM) {
                return RsmssResult {metal::clamp(px - py, 0.0, 1.0), 6u};
            }
            return RsmssResult {1.0, 6u};
        }
        uint _e333 = rsmss_fetch_n_right(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e333 == RSMSS_V_TOP) {
            return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 6u};
        }
        if (_e303 == RSMSS_V_TOP) {
            return RsmssResult {metal::clamp(py - px, 0.0, 1.0), 6u};
        }
        if (_e333 == RSMSS_V_BOTTOM) {
            return RsmssResult {metal::clamp(px - py, 0.0, 1.0), 6u};
        }
        if (_e303 == RSMSS_V_BOTTOM) {
            return RsmssResult {metal::clamp((1.0 - px) - py, 0.0, 1.0), 6u};
        }
        return RsmssResult {1.0, 6u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_16 = V_3 == RSMSS_V_BOTH;
    } else {
        local_16 = false;
    }
    bool _e380 = local_16;
    if (_e380) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_18 = H_3 == RSMSS_H_LEFT;
        } else {
            local_18 = true;
        }
        bool _e391 = local_18;
        local_17 = _e391;
    } else {
        local_17 = false;
    }
    bool _e393 = local_17;
    if (_e393) {
        local_19 = tH_3 == RSMSS_TH_DUAL_POSITIVE;
    } else {
        local_19 = false;
    }
    bool _e399 = local_19;
    if (_e399) {
        if (H_3 == RSMSS_H_LEFT) {
            uint _e402 = rsmss_fetch_n_right(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e402 == RSMSS_V_BOTH) {
                return RsmssResult {metal::clamp(metal::min(metal::min((1.0 + py) - dH, (2.0 - py) - dH), px), 0.0, 1.0), 7u};
            }
            if (_e402 == RSMSS_V_TOP) {
                return RsmssResult {metal::clamp((px + py) - 1.0, 0.0, 1.0), 7u};
            }
            if (_e402 == RSMSS_V_BOTTOM) {
                return RsmssResult {metal::clamp(px - py, 0.0, 1.0), 7u};
            }
            return RsmssResult {1.0, 7u};
        }
        uint _e439 = rsmss_fetch_n_left(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e439 == RSMSS_V_BOTH) {
            return RsmssResult {metal::clamp(metal::min(metal::min((1.0 + py) - dH, (2.0 - py) - dH), 1.0 - px), 0.0, 1.0), 7u};
        }
        if (_e439 == RSMSS_V_TOP) {
            return RsmssResult {metal::clamp(py - px, 0.0, 1.0), 7u};
        }
        if (_e439 == RSMSS_V_BOTTOM) {
            return RsmssResult {metal::clamp((1.0 - px) - py, 0.0, 1.0), 7u};
        }
        return RsmssResult {1.0, 7u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_20 = H_3 == RSMSS_H_BOTH;
    } else {
        local_20 = false;
    }
    bool _e485 = local_20;
    if (_e485) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_22 = V_3 == RSMSS_V_BOTTOM;
        } else {
            local_22 = true;
        }
        bool _e496 = local_22;
        local_21 = _e496;
    } else {
        local_21 = false;
    }
    bool _e498 = local_21;
    if (_e498) {
        local_23 = tV_3 == RSMSS_TH_POSITIVE_NEGATIVE;
    } else {
        local_23 = false;
    }
    bool _e504 = local_23;
    if (_e504) {
        uint _e505 = rsmss_fetch_d_cb_h(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e505 == RSMSS_H_NONE) {
            return RsmssResult {metal::clamp(1.0 - dV, 0.0, 1.0), 8u};
        }
        if (_e505 == RSMSS_H_RIGHT) {
            float w = (V_3 == RSMSS_V_TOP) ? py : (1.0 - py);
            return RsmssResult {metal::clamp(metal::min(w, (2.0 - px) - dV), 0.0, 1.0), 8u};
        }
        if (_e505 == RSMSS_H_LEFT) {
            float w_1 = (V_3 == RSMSS_V_TOP) ? py : (1.0 - py);
            return RsmssResult {metal::clamp(metal::min(w_1, (1.0 + px) - dV), 0.0, 1.0), 8u};
        }
        return RsmssResult {1.0, 8u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_24 = H_3 == RSMSS_H_BOTH;
    } else {
        local_24 = false;
    }
    bool _e557 = local_24;
    if (_e557) {
        local_25 = V_3 == RSMSS_V_NONE;
    } else {
        local_25 = false;
    }
    bool _e563 = local_25;
    if (_e563) {
        local_26 = tV_3 == RSMSS_TH_POSITIVE_NEGATIVE;
    } else {
        local_26 = false;
    }
    bool _e569 = local_26;
    if (_e569) {
        uint _e570 = rsmss_fetch_d_cb_top(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e570 == RSMSS_H_NONE) {
            return RsmssResult {metal::clamp(1.0 - dV, 0.0, 1.0), 9u};
        }
        uint _e580 = rsmss_fetch_d_cb_bottom(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e580 == RSMSS_H_NONE) {
            return RsmssResult {metal::clamp(1.0 - dV, 0.0, 1.0), 9u};
        }
        if (!((_e570 == RSMSS_H_LEFT))) {
            local_27 = _e580 == RSMSS_H_LEFT;
        } else {
            local_27 = true;
        }
        bool _e598 = local_27;
        if (_e598) {
            return RsmssResult {metal::clamp((1.0 + px) - dV, 0.0, 1.0), 9u};
        }
        if (!((_e570 == RSMSS_H_RIGHT))) {
            local_28 = _e580 == RSMSS_H_RIGHT;
        } else {
            local_28 = true;
        }
        bool _e615 = local_28;
        if (_e615) {
            return RsmssResult {metal::clamp((2.0 - px) - dV, 0.0, 1.0), 9u};
        }
        return RsmssResult {1.0, 9u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_29 = V_3 == RSMSS_V_BOTH;
    } else {
        local_29 = false;
    }
    bool _e634 = local_29;
    if (_e634) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_31 = H_3 == RSMSS_H_LEFT;
        } else {
            local_31 = true;
        }
        bool _e645 = local_31;
        local_30 = _e645;
    } else {
        local_30 = false;
    }
    bool _e647 = local_30;
    if (_e647) {
        local_32 = tH_3 == RSMSS_TH_POSITIVE_NEGATIVE;
    } else {
        local_32 = false;
    }
    bool _e653 = local_32;
    if (_e653) {
        uint _e654 = rsmss_fetch_d_cb_v(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e654 == RSMSS_V_NONE) {
            return RsmssResult {metal::clamp(1.0 - dH, 0.0, 1.0), 10u};
        }
        if (_e654 == RSMSS_V_TOP) {
            float u = (H_3 == RSMSS_H_LEFT) ? px : (1.0 - px);
            return RsmssResult {metal::clamp(metal::min(u, (1.0 + py) - dH), 0.0, 1.0), 10u};
        }
        if (_e654 == RSMSS_V_BOTTOM) {
            float u_1 = (H_3 == RSMSS_H_LEFT) ? px : (1.0 - px);
            return RsmssResult {metal::clamp(metal::min(u_1, (2.0 - py) - dH), 0.0, 1.0), 10u};
        }
        return RsmssResult {1.0, 10u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_33 = V_3 == RSMSS_V_BOTH;
    } else {
        local_33 = false;
    }
    bool _e706 = local_33;
    if (_e706) {
        local_34 = H_3 == RSMSS_H_NONE;
    } else {
        local_34 = false;
    }
    bool _e712 = local_34;
    if (_e712) {
        local_35 = tH_3 == RSMSS_TH_POSITIVE_NEGATIVE;
    } else {
        local_35 = false;
    }
    bool _e718 = local_35;
    if (_e718) {
        uint _e719 = rsmss_fetch_d_cb_left(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e719 == RSMSS_V_NONE) {
            return RsmssResult {metal::clamp(1.0 - dH, 0.0, 1.0), 11u};
        }
        uint _e729 = rsmss_fetch_d_cb_right(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e729 == RSMSS_V_NONE) {
            return RsmssResult {metal::clamp(1.0 - dH, 0.0, 1.0), 11u};
        }
        if (!((_e719 == RSMSS_V_TOP))) {
            local_36 = _e729 == RSMSS_V_TOP;
        } else {
            local_36 = true;
        }
        bool _e747 = local_36;
        if (_e747) {
            return RsmssResult {metal::clamp((1.0 + py) - dH, 0.0, 1.0), 11u};
        }
        if (!((_e719 == RSMSS_V_BOTTOM))) {
            local_37 = _e729 == RSMSS_V_BOTTOM;
        } else {
            local_37 = true;
        }
        bool _e764 = local_37;
        if (_e764) {
            return RsmssResult {metal::clamp((2.0 - py) - dH, 0.0, 1.0), 11u};
        }
        return RsmssResult {1.0, 11u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_38 = H_3 == RSMSS_H_BOTH;
    } else {
        local_38 = false;
    }
    bool _e783 = local_38;
    if (_e783) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_40 = V_3 == RSMSS_V_BOTTOM;
        } else {
            local_40 = true;
        }
        bool _e794 = local_40;
        local_39 = _e794;
    } else {
        local_39 = false;
    }
    bool _e796 = local_39;
    if (_e796) {
        if (V_3 == RSMSS_V_TOP) {
            uint _e799 = rsmss_fetch_n_bottom(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e799 == RSMSS_H_NONE) {
                return RsmssResult {metal::clamp(dV, 0.0, 1.0), 12u};
            }
            if (_e799 == RSMSS_H_RIGHT) {
                float B_h = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? px : ((dV + px) - 1.0);
                return RsmssResult {metal::clamp(metal::max(1.0 - py, B_h), 0.0, 1.0), 12u};
            }
            if (_e799 == RSMSS_H_LEFT) {
                float A_h = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - px) : (dV - px);
                return RsmssResult {metal::clamp(metal::max(1.0 - py, A_h), 0.0, 1.0), 12u};
            }
            uint _e839 = rsmss_fetch_d_cb_h(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e839 == RSMSS_H_NONE) {
                return RsmssResult {metal::clamp(dV, 0.0, 1.0), 12u};
            }
            if (_e839 == RSMSS_H_LEFT) {
                return RsmssResult {metal::clamp(metal::max(1.0 - py, 1.0 - px), 0.0, 1.0), 12u};
            }
            if (_e839 == RSMSS_H_RIGHT) {
                return RsmssResult {metal::clamp(metal::max(1.0 - py, px), 0.0, 1.0), 12u};
            }
            return RsmssResult {0.0, 12u};
        }
        uint _e872 = rsmss_fetch_n_top(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e872 == RSMSS_H_NONE) {
            return RsmssResult {metal::clamp(dV, 0.0, 1.0), 12u};
        }
        if (_e872 == RSMSS_H_RIGHT) {
            float B_h_1 = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? px : ((dV + px) - 1.0);
            return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - py), B_h_1), 0.0, 1.0), 12u};
        }
        if (_e872 == RSMSS_H_LEFT) {
            float A_h_1 = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - px) : (dV - px);
            return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - py), A_h_1), 0.0, 1.0), 12u};
        }
        uint _e916 = rsmss_fetch_d_cb_h(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e916 == RSMSS_H_NONE) {
            return RsmssResult {metal::clamp(dV, 0.0, 1.0), 12u};
        }
        if (_e916 == RSMSS_H_LEFT) {
            return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - py), 1.0 - px), 0.0, 1.0), 12u};
        }
        if (_e916 == RSMSS_H_RIGHT) {
            return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - py), px), 0.0, 1.0), 12u};
        }
        return RsmssResult {0.0, 12u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_41 = H_3 == RSMSS_H_BOTH;
    } else {
        local_41 = false;
    }
    bool _e960 = local_41;
    if (_e960) {
        local_42 = V_3 == RSMSS_V_NONE;
    } else {
        local_42 = false;
    }
    bool _e966 = local_42;
    if (_e966) {
        uint _e967 = rsmss_fetch_d_cb_h(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e967 == RSMSS_H_NONE) {
            return RsmssResult {metal::clamp(dV, 0.0, 1.0), 13u};
        }
        if (_e967 == RSMSS_H_LEFT) {
            float A_h_2 = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - px) : (dV - px);
            return RsmssResult {metal::clamp(A_h_2, 0.0, 1.0), 13u};
        }
        if (_e967 == RSMSS_H_RIGHT) {
            float B_h_2 = (tV_3 == RSMSS_TH_DUAL_POSITIVE) ? px : ((dV + px) - 1.0);
            return RsmssResult {metal::clamp(B_h_2, 0.0, 1.0), 13u};
        }
        return RsmssResult {0.0, 13u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_43 = V_3 == RSMSS_V_BOTH;
    } else {
        local_43 = false;
    }
    bool _e1011 = local_43;
    if (_e1011) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_45 = H_3 == RSMSS_H_LEFT;
        } else {
            local_45 = true;
        }
        bool _e1022 = local_45;
        local_44 = _e1022;
    } else {
        local_44 = false;
    }
    bool _e1024 = local_44;
    if (_e1024) {
        if (H_3 == RSMSS_H_LEFT) {
            uint _e1027 = rsmss_fetch_n_right(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e1027 == RSMSS_V_NONE) {
                return RsmssResult {metal::clamp(dH, 0.0, 1.0), 14u};
            }
            if (_e1027 == RSMSS_V_BOTTOM) {
                float B_v = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? py : ((dH + py) - 1.0);
                return RsmssResult {metal::clamp(metal::max(1.0 - px, B_v), 0.0, 1.0), 14u};
            }
            if (_e1027 == RSMSS_V_TOP) {
                float A_v = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - py) : (dH - py);
                return RsmssResult {metal::clamp(metal::max(1.0 - px, A_v), 0.0, 1.0), 14u};
            }
            uint _e1067 = rsmss_fetch_d_cb_v(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
            if (_e1067 == RSMSS_V_NONE) {
                return RsmssResult {metal::clamp(dH, 0.0, 1.0), 14u};
            }
            if (_e1067 == RSMSS_V_TOP) {
                return RsmssResult {metal::clamp(metal::max(1.0 - px, 1.0 - py), 0.0, 1.0), 14u};
            }
            if (_e1067 == RSMSS_V_BOTTOM) {
                return RsmssResult {metal::clamp(metal::max(1.0 - px, py), 0.0, 1.0), 14u};
            }
            return RsmssResult {0.0, 14u};
        }
        uint _e1100 = rsmss_fetch_n_left(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e1100 == RSMSS_V_NONE) {
            return RsmssResult {metal::clamp(dH, 0.0, 1.0), 14u};
        }
        if (_e1100 == RSMSS_V_BOTTOM) {
            float B_v_1 = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? py : ((dH + py) - 1.0);
            return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - px), B_v_1), 0.0, 1.0), 14u};
        }
        if (_e1100 == RSMSS_V_TOP) {
            float A_v_1 = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - py) : (dH - py);
            return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - px), A_v_1), 0.0, 1.0), 14u};
        }
        uint _e1144 = rsmss_fetch_d_cb_v(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e1144 == RSMSS_V_NONE) {
            return RsmssResult {metal::clamp(dH, 0.0, 1.0), 14u};
        }
        if (_e1144 == RSMSS_V_TOP) {
            return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - px), 1.0 - py), 0.0, 1.0), 14u};
        }
        if (_e1144 == RSMSS_V_BOTTOM) {
            return RsmssResult {metal::clamp(metal::max(1.0 - (1.0 - px), py), 0.0, 1.0), 14u};
        }
        return RsmssResult {0.0, 14u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_46 = V_3 == RSMSS_V_BOTH;
    } else {
        local_46 = false;
    }
    bool _e1188 = local_46;
    if (_e1188) {
        local_47 = H_3 == RSMSS_H_NONE;
    } else {
        local_47 = false;
    }
    bool _e1194 = local_47;
    if (_e1194) {
        uint _e1195 = rsmss_fetch_d_cb_v(site_10, umbrage_out, umbrage_fetched, _buffer_sizes);
        if (_e1195 == RSMSS_V_NONE) {
            return RsmssResult {metal::clamp(dH, 0.0, 1.0), 15u};
        }
        if (_e1195 == RSMSS_V_TOP) {
            float A_v_2 = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? (1.0 - py) : (dH - py);
            return RsmssResult {metal::clamp(A_v_2, 0.0, 1.0), 15u};
        }
        if (_e1195 == RSMSS_V_BOTTOM) {
            float B_v_2 = (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? py : ((dH + py) - 1.0);
            return RsmssResult {metal::clamp(B_v_2, 0.0, 1.0), 15u};
        }
        return RsmssResult {0.0, 15u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_49 = H_3 == RSMSS_H_LEFT;
        } else {
            local_49 = true;
        }
        bool _e1244 = local_49;
        local_48 = _e1244;
    } else {
        local_48 = false;
    }
    bool _e1246 = local_48;
    if (_e1246) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_51 = V_3 == RSMSS_V_BOTTOM;
        } else {
            local_51 = true;
        }
        bool _e1257 = local_51;
        local_50 = _e1257;
    } else {
        local_50 = false;
    }
    bool _e1259 = local_50;
    if (_e1259) {
        local_52 = domH_3;
    } else {
        local_52 = false;
    }
    bool _e1263 = local_52;
    if (_e1263) {
        local_53 = !(domV_3);
    } else {
        local_53 = false;
    }
    bool _e1268 = local_53;
    if (_e1268) {
        float u_2 = (H_3 == RSMSS_H_LEFT) ? px : (1.0 - px);
        float F23_ = (H_3 == RSMSS_H_LEFT) ? ((1.0 + px) - dV) : ((2.0 - px) - dV);
        return RsmssResult {metal::clamp((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? u_2 : F23_, 0.0, 1.0), 16u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_55 = H_3 == RSMSS_H_LEFT;
        } else {
            local_55 = true;
        }
        bool _e1303 = local_55;
        local_54 = _e1303;
    } else {
        local_54 = false;
    }
    bool _e1305 = local_54;
    if (_e1305) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_57 = V_3 == RSMSS_V_BOTTOM;
        } else {
            local_57 = true;
        }
        bool _e1316 = local_57;
        local_56 = _e1316;
    } else {
        local_56 = false;
    }
    bool _e1318 = local_56;
    if (_e1318) {
        local_58 = domV_3;
    } else {
        local_58 = false;
    }
    bool _e1322 = local_58;
    if (_e1322) {
        local_59 = !(domH_3);
    } else {
        local_59 = false;
    }
    bool _e1327 = local_59;
    if (_e1327) {
        float F20_ = (V_3 == RSMSS_V_BOTTOM) ? (1.0 - py) : py;
        float F22_ = (V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH);
        return RsmssResult {metal::clamp((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F20_ : F22_, 0.0, 1.0), 17u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_61 = H_3 == RSMSS_H_LEFT;
        } else {
            local_61 = true;
        }
        bool _e1362 = local_61;
        local_60 = _e1362;
    } else {
        local_60 = false;
    }
    bool _e1364 = local_60;
    if (_e1364) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_63 = V_3 == RSMSS_V_BOTTOM;
        } else {
            local_63 = true;
        }
        bool _e1375 = local_63;
        local_62 = _e1375;
    } else {
        local_62 = false;
    }
    bool _e1377 = local_62;
    if (_e1377) {
        local_64 = !(domH_3);
    } else {
        local_64 = false;
    }
    bool _e1382 = local_64;
    if (_e1382) {
        local_65 = !(domV_3);
    } else {
        local_65 = false;
    }
    bool _e1387 = local_65;
    if (_e1387) {
        float F22_1 = (V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH);
        return RsmssResult {metal::clamp(F22_1, 0.0, 1.0), 18u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_67 = H_3 == RSMSS_H_LEFT;
        } else {
            local_67 = true;
        }
        bool _e1414 = local_67;
        local_66 = _e1414;
    } else {
        local_66 = false;
    }
    bool _e1416 = local_66;
    if (_e1416) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_69 = V_3 == RSMSS_V_BOTTOM;
        } else {
            local_69 = true;
        }
        bool _e1427 = local_69;
        local_68 = _e1427;
    } else {
        local_68 = false;
    }
    bool _e1429 = local_68;
    if (_e1429) {
        local_70 = domH_3;
    } else {
        local_70 = false;
    }
    bool _e1433 = local_70;
    if (_e1433) {
        local_71 = domV_3;
    } else {
        local_71 = false;
    }
    bool _e1437 = local_71;
    if (_e1437) {
        float u_3 = (H_3 == RSMSS_H_LEFT) ? px : (1.0 - px);
        float F23_1 = (H_3 == RSMSS_H_LEFT) ? ((1.0 + px) - dV) : ((2.0 - px) - dV);
        float F20_1 = (V_3 == RSMSS_V_BOTTOM) ? (1.0 - py) : py;
        float F22_2 = (V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH);
        return RsmssResult {metal::clamp(metal::min((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? u_3 : F23_1, (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F20_1 : F22_2), 0.0, 1.0), 19u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_72 = H_3 != RSMSS_H_BOTH;
    } else {
        local_72 = false;
    }
    bool _e1485 = local_72;
    if (_e1485) {
        local_73 = V_3 != RSMSS_V_BOTH;
    } else {
        local_73 = false;
    }
    bool _e1491 = local_73;
    if (_e1491) {
        local_74 = tH_3 == RSMSS_TH_DUAL_POSITIVE;
    } else {
        local_74 = false;
    }
    bool _e1497 = local_74;
    if (_e1497) {
        local_75 = tV_3 == RSMSS_TH_POSITIVE_NEGATIVE;
    } else {
        local_75 = false;
    }
    bool _e1503 = local_75;
    if (_e1503) {
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
    bool _e1530 = local_76;
    if (_e1530) {
        local_77 = V_3 != RSMSS_V_BOTH;
    } else {
        local_77 = false;
    }
    bool _e1536 = local_77;
    if (_e1536) {
        local_78 = tH_3 == RSMSS_TH_POSITIVE_NEGATIVE;
    } else {
        local_78 = false;
    }
    bool _e1542 = local_78;
    if (_e1542) {
        local_79 = tV_3 == RSMSS_TH_DUAL_POSITIVE;
    } else {
        local_79 = false;
    }
    bool _e1548 = local_79;
    if (_e1548) {
        if (H_3 == RSMSS_H_LEFT) {
            return RsmssResult {metal::clamp(px, 0.0, 1.0), 21u};
        }
        if (H_3 == RSMSS_H_RIGHT) {
            return RsmssResult {metal::clamp(1.0 - px, 0.0, 1.0), 21u};
        }
        return RsmssResult {1.0, 21u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_80 = H_3 != RSMSS_H_BOTH;
    } else {
        local_80 = false;
    }
    bool _e1575 = local_80;
    if (_e1575) {
        local_81 = V_3 != RSMSS_V_BOTH;
    } else {
        local_81 = false;
    }
    bool _e1581 = local_81;
    if (_e1581) {
        local_82 = H_3 == RSMSS_H_NONE;
    } else {
        local_82 = false;
    }
    bool _e1587 = local_82;
    if (_e1587) {
        local_83 = V_3 != RSMSS_V_NONE;
    } else {
        local_83 = false;
    }
    bool _e1593 = local_83;
    if (_e1593) {
        float F22_3 = (V_3 == RSMSS_V_BOTTOM) ? ((2.0 - py) - dH) : ((1.0 + py) - dH);
        return RsmssResult {metal::clamp(F22_3, 0.0, 1.0), 22u};
    }
    if (b_3 == RSMSS_B_ENTERING) {
        local_84 = H_3 != RSMSS_H_BOTH;
    } else {
        local_84 = false;
    }
    bool _e1615 = local_84;
    if (_e1615) {
        local_85 = V_3 != RSMSS_V_BOTH;
    } else {
        local_85 = false;
    }
    bool _e1621 = local_85;
    if (_e1621) {
        local_86 = H_3 != RSMSS_H_NONE;
    } else {
        local_86 = false;
    }
    bool _e1627 = local_86;
    if (_e1627) {
        local_87 = V_3 == RSMSS_V_NONE;
    } else {
        local_87 = false;
    }
    bool _e1633 = local_87;
    if (_e1633) {
        float F23_2 = (H_3 == RSMSS_H_LEFT) ? ((1.0 + px) - dV) : ((2.0 - px) - dV);
        return RsmssResult {metal::clamp(F23_2, 0.0, 1.0), 23u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_89 = H_3 == RSMSS_H_LEFT;
        } else {
            local_89 = true;
        }
        bool _e1660 = local_89;
        local_88 = _e1660;
    } else {
        local_88 = false;
    }
    bool _e1662 = local_88;
    if (_e1662) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_91 = V_3 == RSMSS_V_BOTTOM;
        } else {
            local_91 = true;
        }
        bool _e1673 = local_91;
        local_90 = _e1673;
    } else {
        local_90 = false;
    }
    bool _e1675 = local_90;
    if (_e1675) {
        local_92 = domH_3;
    } else {
        local_92 = false;
    }
    bool _e1679 = local_92;
    if (_e1679) {
        local_93 = !(domV_3);
    } else {
        local_93 = false;
    }
    bool _e1684 = local_93;
    if (_e1684) {
        float F29_ = (H_3 == RSMSS_H_LEFT) ? (1.0 - px) : px;
        float F31_ = (H_3 == RSMSS_H_LEFT) ? (dV - px) : ((px + dV) - 1.0);
        return RsmssResult {metal::clamp((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? F29_ : F31_, 0.0, 1.0), 24u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_95 = H_3 == RSMSS_H_LEFT;
        } else {
            local_95 = true;
        }
        bool _e1717 = local_95;
        local_94 = _e1717;
    } else {
        local_94 = false;
    }
    bool _e1719 = local_94;
    if (_e1719) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_97 = V_3 == RSMSS_V_BOTTOM;
        } else {
            local_97 = true;
        }
        bool _e1730 = local_97;
        local_96 = _e1730;
    } else {
        local_96 = false;
    }
    bool _e1732 = local_96;
    if (_e1732) {
        local_98 = domV_3;
    } else {
        local_98 = false;
    }
    bool _e1736 = local_98;
    if (_e1736) {
        local_99 = !(domH_3);
    } else {
        local_99 = false;
    }
    bool _e1741 = local_99;
    if (_e1741) {
        float F28_ = (V_3 == RSMSS_V_BOTTOM) ? py : (1.0 - py);
        float F30_ = (V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py);
        return RsmssResult {metal::clamp((tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F28_ : F30_, 0.0, 1.0), 25u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_101 = H_3 == RSMSS_H_LEFT;
        } else {
            local_101 = true;
        }
        bool _e1774 = local_101;
        local_100 = _e1774;
    } else {
        local_100 = false;
    }
    bool _e1776 = local_100;
    if (_e1776) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_103 = V_3 == RSMSS_V_BOTTOM;
        } else {
            local_103 = true;
        }
        bool _e1787 = local_103;
        local_102 = _e1787;
    } else {
        local_102 = false;
    }
    bool _e1789 = local_102;
    if (_e1789) {
        local_104 = !(domH_3);
    } else {
        local_104 = false;
    }
    bool _e1794 = local_104;
    if (_e1794) {
        local_105 = !(domV_3);
    } else {
        local_105 = false;
    }
    bool _e1799 = local_105;
    if (_e1799) {
        float F30_1 = (V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py);
        return RsmssResult {metal::clamp(F30_1, 0.0, 1.0), 26u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        if (!((H_3 == RSMSS_H_RIGHT))) {
            local_107 = H_3 == RSMSS_H_LEFT;
        } else {
            local_107 = true;
        }
        bool _e1824 = local_107;
        local_106 = _e1824;
    } else {
        local_106 = false;
    }
    bool _e1826 = local_106;
    if (_e1826) {
        if (!((V_3 == RSMSS_V_TOP))) {
            local_109 = V_3 == RSMSS_V_BOTTOM;
        } else {
            local_109 = true;
        }
        bool _e1837 = local_109;
        local_108 = _e1837;
    } else {
        local_108 = false;
    }
    bool _e1839 = local_108;
    if (_e1839) {
        local_110 = domH_3;
    } else {
        local_110 = false;
    }
    bool _e1843 = local_110;
    if (_e1843) {
        local_111 = domV_3;
    } else {
        local_111 = false;
    }
    bool _e1847 = local_111;
    if (_e1847) {
        float F29_1 = (H_3 == RSMSS_H_LEFT) ? (1.0 - px) : px;
        float F31_1 = (H_3 == RSMSS_H_LEFT) ? (dV - px) : ((px + dV) - 1.0);
        float F28_1 = (V_3 == RSMSS_V_BOTTOM) ? py : (1.0 - py);
        float F30_2 = (V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py);
        return RsmssResult {metal::clamp(metal::max((tV_3 == RSMSS_TH_DUAL_POSITIVE) ? F29_1 : F31_1, (tH_3 == RSMSS_TH_DUAL_POSITIVE) ? F28_1 : F30_2), 0.0, 1.0), 27u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_112 = H_3 != RSMSS_H_BOTH;
    } else {
        local_112 = false;
    }
    bool _e1891 = local_112;
    if (_e1891) {
        local_113 = V_3 != RSMSS_V_BOTH;
    } else {
        local_113 = false;
    }
    bool _e1897 = local_113;
    if (_e1897) {
        local_114 = tH_3 == RSMSS_TH_DUAL_POSITIVE;
    } else {
        local_114 = false;
    }
    bool _e1903 = local_114;
    if (_e1903) {
        local_115 = tV_3 == RSMSS_TH_POSITIVE_NEGATIVE;
    } else {
        local_115 = false;
    }
    bool _e1909 = local_115;
    if (_e1909) {
        if (V_3 == RSMSS_V_BOTTOM) {
            return RsmssResult {metal::clamp(py, 0.0, 1.0), 28u};
        }
        if (V_3 == RSMSS_V_TOP) {
            return RsmssResult {metal::clamp(1.0 - py, 0.0, 1.0), 28u};
        }
        return RsmssResult {0.0, 28u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_116 = H_3 != RSMSS_H_BOTH;
    } else {
        local_116 = false;
    }
    bool _e1936 = local_116;
    if (_e1936) {
        local_117 = V_3 != RSMSS_V_BOTH;
    } else {
        local_117 = false;
    }
    bool _e1942 = local_117;
    if (_e1942) {
        local_118 = tH_3 == RSMSS_TH_POSITIVE_NEGATIVE;
    } else {
        local_118 = false;
    }
    bool _e1948 = local_118;
    if (_e1948) {
        local_119 = tV_3 == RSMSS_TH_DUAL_POSITIVE;
    } else {
        local_119 = false;
    }
    bool _e1954 = local_119;
    if (_e1954) {
        if (H_3 == RSMSS_H_LEFT) {
            return RsmssResult {metal::clamp(1.0 - px, 0.0, 1.0), 29u};
        }
        if (H_3 == RSMSS_H_RIGHT) {
            return RsmssResult {metal::clamp(px, 0.0, 1.0), 29u};
        }
        return RsmssResult {0.0, 29u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_120 = H_3 != RSMSS_H_BOTH;
    } else {
        local_120 = false;
    }
    bool _e1981 = local_120;
    if (_e1981) {
        local_121 = V_3 != RSMSS_V_BOTH;
    } else {
        local_121 = false;
    }
    bool _e1987 = local_121;
    if (_e1987) {
        local_122 = H_3 == RSMSS_H_NONE;
    } else {
        local_122 = false;
    }
    bool _e1993 = local_122;
    if (_e1993) {
        local_123 = V_3 != RSMSS_V_NONE;
    } else {
        local_123 = false;
    }
    bool _e1999 = local_123;
    if (_e1999) {
        float F30_3 = (V_3 == RSMSS_V_BOTTOM) ? ((py + dH) - 1.0) : (dH - py);
        return RsmssResult {metal::clamp(F30_3, 0.0, 1.0), 30u};
    }
    if (b_3 == RSMSS_B_EXITING) {
        local_124 = H_3 != RSMSS_H_BOTH;
    } else {
        local_124 = false;
    }
    bool _e2019 = local_124;
    if (_e2019) {
        local_125 = V_3 != RSMSS_V_BOTH;
    } else {
        local_125 = false;
    }
    bool _e2025 = local_125;
    if (_e2025) {
        local_126 = H_3 != RSMSS_H_NONE;
    } else {
        local_126 = false;
    }
    bool _e2031 = local_126;
    if (_e2031) {
        local_127 = V_3 == RSMSS_V_NONE;
    } else {
        local_127 = false;
    }
    bool _e2037 = local_127;
    if (_e2037) {
        float F31_2 = (H_3 == RSMSS_H_LEFT) ? (dV - px) : ((px + dV) - 1.0);
        return RsmssResult {metal::clamp(F31_2, 0.0, 1.0), 31u};
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
