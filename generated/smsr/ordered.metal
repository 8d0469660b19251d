// language: metal2.0
#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;

struct _mslBufferSizes {
    uint size0;
    uint size1;
};

struct SmsrResult {
    float value;
    uint case_id;
};
typedef uint type_3[1];
constant uint SMSR_H_NONE = 0u;
constant uint SMSR_H_RIGHT = 1u;
constant uint SMSR_H_LEFT = 2u;
constant uint SMSR_H_BOTH = 3u;
constant uint SMSR_V_NONE = 0u;
constant uint SMSR_V_TOP = 1u;
constant uint SMSR_V_BOTTOM = 2u;
constant uint SMSR_V_BOTH = 3u;
constant uint SMSR_TH_DUAL_NEGATIVE = 0u;
constant uint SMSR_TH_POSITIVE_NEGATIVE = 1u;
constant uint SMSR_TH_DUAL_POSITIVE = 2u;
constant uint SMSR_DEFAULT = 4294967295u;

uint smsr_H_level(
    float code
) {
    return (static_cast<uint>(code >= 0.125) + static_cast<uint>(code >= 0.375)) + static_cast<uint>(code >= 0.625);
}

uint smsr_V_level(
    float code_1
) {
    return (static_cast<uint>(code_1 >= 0.125) + static_cast<uint>(code_1 >= 0.375)) + static_cast<uint>(code_1 >= 0.625);
}

uint smsr_tH_level(
    float code_2
) {
    return static_cast<uint>(code_2 >= -0.5) + static_cast<uint>(code_2 >= 0.5);
}

uint smsr_pack(
    float H,
    float V,
    float tH,
    float tV,
    bool domH,
    bool domV
) {
    uint _e6 = smsr_H_level(H);
    uint _e7 = smsr_V_level(V);
    uint _e11 = smsr_tH_level(tH);
    uint _e15 = smsr_tH_level(tV);
    return ((((_e6 | (_e7 << 2u)) | (_e11 << 4u)) | (_e15 << 6u)) | (static_cast<uint>(domH) << 8u)) | (static_cast<uint>(domV) << 9u);
}

SmsrResult smsr_key_case(
    uint key,
    float dH,
    float dV,
    float px,
    float py
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
    uint H_3 = key & 3u;
    uint V_3 = (key >> 2u) & 3u;
    uint tH_3 = (key >> 4u) & 3u;
    uint tV_3 = (key >> 6u) & 3u;
    bool domH_3 = ((key >> 8u) & 1u) != 0u;
    bool domV_3 = ((key >> 9u) & 1u) != 0u;
    if (!((tH_3 == SMSR_TH_DUAL_NEGATIVE))) {
        local = tV_3 == SMSR_TH_DUAL_NEGATIVE;
    } else {
        local = true;
    }
    bool _e39 = local;
    if (_e39) {
        return SmsrResult {1.0, 1u};
    }
    if (!((tH_3 == SMSR_TH_DUAL_POSITIVE))) {
        local_1 = tV_3 == SMSR_TH_DUAL_POSITIVE;
    } else {
        local_1 = true;
    }
    bool _e51 = local_1;
    if (_e51) {
        return SmsrResult {0.0, 2u};
    }
    if (H_3 == SMSR_H_RIGHT) {
        local_2 = V_3 == SMSR_V_NONE;
    } else {
        local_2 = false;
    }
    bool _e62 = local_2;
    if (_e62) {
        local_3 = tH_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_3 = false;
    }
    bool _e68 = local_3;
    if (_e68) {
        local_4 = tV_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_4 = false;
    }
    bool _e74 = local_4;
    if (_e74) {
        if ((1.0 - px) < dV) {
            return SmsrResult {0.0, 12u};
        }
        return SmsrResult {1.0, 12u};
    }
    if (H_3 == SMSR_H_LEFT) {
        local_5 = V_3 == SMSR_V_NONE;
    } else {
        local_5 = false;
    }
    bool _e91 = local_5;
    if (_e91) {
        local_6 = tH_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_6 = false;
    }
    bool _e97 = local_6;
    if (_e97) {
        local_7 = tV_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_7 = false;
    }
    bool _e103 = local_7;
    if (_e103) {
        if (px < dV) {
            return SmsrResult {0.0, 11u};
        }
        return SmsrResult {1.0, 11u};
    }
    if (H_3 == SMSR_H_NONE) {
        local_8 = V_3 == SMSR_V_BOTTOM;
    } else {
        local_8 = false;
    }
    bool _e118 = local_8;
    if (_e118) {
        local_9 = tH_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_9 = false;
    }
    bool _e124 = local_9;
    if (_e124) {
        local_10 = tV_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_10 = false;
    }
    bool _e130 = local_10;
    if (_e130) {
        if ((1.0 - py) < dH) {
            return SmsrResult {0.0, 9u};
        }
        return SmsrResult {1.0, 9u};
    }
    if (H_3 == SMSR_H_NONE) {
        local_11 = V_3 == SMSR_V_TOP;
    } else {
        local_11 = false;
    }
    bool _e147 = local_11;
    if (_e147) {
        local_12 = tH_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_12 = false;
    }
    bool _e153 = local_12;
    if (_e153) {
        local_13 = tV_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_13 = false;
    }
    bool _e159 = local_13;
    if (_e159) {
        if (py < dH) {
            return SmsrResult {0.0, 10u};
        }
        return SmsrResult {1.0, 10u};
    }
    if (!((H_3 == SMSR_H_RIGHT))) {
        local_14 = H_3 == SMSR_H_LEFT;
    } else {
        local_14 = true;
    }
    bool _e175 = local_14;
    if (_e175) {
        if (!((V_3 == SMSR_V_TOP))) {
            local_16 = V_3 == SMSR_V_BOTTOM;
        } else {
            local_16 = true;
        }
        bool _e186 = local_16;
        local_15 = _e186;
    } else {
        local_15 = false;
    }
    bool _e188 = local_15;
    if (_e188) {
        local_17 = domH_3;
    } else {
        local_17 = false;
    }
    bool _e192 = local_17;
    if (_e192) {
        local_18 = !(domV_3);
    } else {
        local_18 = false;
    }
    bool _e197 = local_18;
    if (_e197) {
        local_19 = tH_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_19 = false;
    }
    bool _e203 = local_19;
    if (_e203) {
        local_20 = tV_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_20 = false;
    }
    bool _e209 = local_20;
    if (_e209) {
        return SmsrResult {(H_3 == SMSR_H_LEFT) ? ((px < dV) ? 0.0 : 1.0) : (((1.0 - px) < dV) ? 0.0 : 1.0), 4u};
    }
    if (!((H_3 == SMSR_H_RIGHT))) {
        local_21 = H_3 == SMSR_H_LEFT;
    } else {
        local_21 = true;
    }
    bool _e233 = local_21;
    if (_e233) {
        if (!((V_3 == SMSR_V_TOP))) {
            local_23 = V_3 == SMSR_V_BOTTOM;
        } else {
            local_23 = true;
        }
        bool _e244 = local_23;
        local_22 = _e244;
    } else {
        local_22 = false;
    }
    bool _e246 = local_22;
    if (_e246) {
        local_24 = domV_3;
    } else {
        local_24 = false;
    }
    bool _e250 = local_24;
    if (_e250) {
        local_25 = !(domH_3);
    } else {
        local_25 = false;
    }
    bool _e255 = local_25;
    if (_e255) {
        local_26 = tH_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_26 = false;
    }
    bool _e261 = local_26;
    if (_e261) {
        local_27 = tV_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_27 = false;
    }
    bool _e267 = local_27;
    if (_e267) {
        return SmsrResult {(V_3 == SMSR_V_BOTTOM) ? (((1.0 - py) < dH) ? 0.0 : 1.0) : ((py < dH) ? 0.0 : 1.0), 5u};
    }
    if (!((H_3 == SMSR_H_RIGHT))) {
        local_28 = H_3 == SMSR_H_LEFT;
    } else {
        local_28 = true;
    }
    bool _e291 = local_28;
    if (_e291) {
        local_29 = V_3 == SMSR_V_TOP;
    } else {
        local_29 = false;
    }
    bool _e297 = local_29;
    if (_e297) {
        local_30 = !(domH_3);
    } else {
        local_30 = false;
    }
    bool _e302 = local_30;
    if (_e302) {
        local_31 = !(domV_3);
    } else {
        local_31 = false;
    }
    bool _e307 = local_31;
    if (_e307) {
        local_32 = tH_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_32 = false;
    }
    bool _e313 = local_32;
    if (_e313) {
        local_33 = tV_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_33 = false;
    }
    bool _e319 = local_33;
    if (_e319) {
        if ((1.0 - dH) < (1.0 - py)) {
            return SmsrResult {0.0, 7u};
        }
        return SmsrResult {1.0, 7u};
    }
    if (!((H_3 == SMSR_H_RIGHT))) {
        local_34 = H_3 == SMSR_H_LEFT;
    } else {
        local_34 = true;
    }
    bool _e339 = local_34;
    if (_e339) {
        local_35 = V_3 == SMSR_V_BOTTOM;
    } else {
        local_35 = false;
    }
    bool _e345 = local_35;
    if (_e345) {
        local_36 = !(domH_3);
    } else {
        local_36 = false;
    }
    bool _e350 = local_36;
    if (_e350) {
        local_37 = !(domV_3);
    } else {
        local_37 = false;
    }
    bool _e355 = local_37;
    if (_e355) {
        local_38 = tH_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_38 = false;
    }
    bool _e361 = local_38;
    if (_e361) {
        local_39 = tV_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_39 = false;
    }
    bool _e367 = local_39;
    if (_e367) {
        if ((1.0 - dH) < py) {
            return SmsrResult {0.0, 6u};
        }
        return SmsrResult {1.0, 6u};
    }
    if (!((H_3 == SMSR_H_BOTH))) {
        local_40 = V_3 == SMSR_V_BOTH;
    } else {
        local_40 = true;
    }
    bool _e385 = local_40;
    if (_e385) {
        return SmsrResult {0.0, 3u};
    }
    if (!((H_3 == SMSR_H_RIGHT))) {
        local_41 = H_3 == SMSR_H_LEFT;
    } else {
        local_41 = true;
    }
    bool _e397 = local_41;
    if (_e397) {
        if (!((V_3 == SMSR_V_TOP))) {
            local_43 = V_3 == SMSR_V_BOTTOM;
        } else {
            local_43 = true;
        }
        bool _e408 = local_43;
        local_42 = _e408;
    } else {
        local_42 = false;
    }
    bool _e410 = local_42;
    if (_e410) {
        local_44 = domH_3;
    } else {
        local_44 = false;
    }
    bool _e414 = local_44;
    if (_e414) {
        local_45 = domV_3;
    } else {
        local_45 = false;
    }
    bool _e418 = local_45;
    if (_e418) {
        local_46 = tH_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_46 = false;
    }
    bool _e424 = local_46;
    if (_e424) {
        local_47 = tV_3 == SMSR_TH_POSITIVE_NEGATIVE;
    } else {
        local_47 = false;
    }
    bool _e430 = local_47;
    if (_e430) {
        return SmsrResult {metal::min((V_3 == SMSR_V_BOTTOM) ? (((1.0 - py) < dH) ? 0.0 : 1.0) : ((py < dH) ? 0.0 : 1.0), (H_3 == SMSR_H_LEFT) ? ((px < dV) ? 0.0 : 1.0) : (((1.0 - px) < dV) ? 0.0 : 1.0)), 8u};
    }
    return SmsrResult {1.0, 4294967295u};
}

float smsr_key(
    uint key_1,
    float dH_1,
    float dV_1,
    float px_1,
    float py_1
) {
    SmsrResult _e5 = smsr_key_case(key_1, dH_1, dV_1, px_1, py_1);
    return _e5.value;
}

SmsrResult smsr_case(
    float H_1,
    float V_1,
    float tH_1,
    float tV_1,
    float dH_2,
    float dV_2,
    float px_2,
    float py_2,
    bool domH_1,
    bool domV_1
) {
    uint _e10 = smsr_pack(H_1, V_1, tH_1, tV_1, domH_1, domV_1);
    SmsrResult _e11 = smsr_key_case(_e10, dH_2, dV_2, px_2, py_2);
    return _e11;
}

float smsr(
    float H_2,
    float V_2,
    float tH_2,
    float tV_2,
    float dH_3,
    float dV_3,
    float px_3,
    float py_3,
    bool domH_2,
    bool domV_2
) {
    SmsrResult _e10 = smsr_case(H_2, V_2, tH_2, tV_2, dH_3, dV_3, px_3, py_3, domH_2, domV_2);
    return _e10.value;
}

struct smsr_columnsInput {
};
kernel void smsr_columns(
  metal::uint3 id [[thread_position_in_grid]]
, device type_3 const& umbrage_plain [[user(fake0)]]
, device type_3& umbrage_out [[user(fake0)]]
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
    SmsrResult _e39 = smsr_key_case(_e14, as_type<float>(_e19), as_type<float>(_e25), as_type<float>(_e31), as_type<float>(_e37));
    umbrage_out[(row * 2u) + 0u] = _e39.case_id;
    umbrage_out[(row * 2u) + 1u] = as_type<uint>(_e39.value);
    return;
}
