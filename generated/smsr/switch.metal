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

uint smsr_lookup(
    uint word
) {
    switch(word) {
        case 20u:
        case 84u:
        case 148u:
        case 212u: {
            return 84674049u;
        }
        case 21u: {
            return 84346627u;
        }
        case 22u: {
            return 84609796u;
        }
        case 23u:
        case 87u:
        case 151u:
        case 215u: {
            return 84215045u;
        }
        case 24u:
        case 25u:
        case 26u:
        case 27u:
        case 36u:
        case 37u:
        case 38u:
        case 39u:
        case 40u:
        case 41u:
        case 42u:
        case 43u:
        case 88u:
        case 89u:
        case 90u:
        case 91u:
        case 100u:
        case 101u:
        case 102u:
        case 103u:
        case 104u:
        case 105u:
        case 106u:
        case 107u:
        case 152u:
        case 153u:
        case 154u:
        case 155u:
        case 164u:
        case 165u:
        case 166u:
        case 167u:
        case 168u:
        case 169u:
        case 170u:
        case 171u:
        case 216u:
        case 217u:
        case 218u:
        case 219u:
        case 228u:
        case 229u:
        case 230u:
        case 231u:
        case 232u:
        case 233u:
        case 234u:
        case 235u: {
            return 33686018u;
        }
        case 85u: {
            return 84478211u;
        }
        case 86u: {
            return 84478212u;
        }
        case 149u: {
            return 84412419u;
        }
        case 150u: {
            return 84412420u;
        }
        case 213u: {
            return 84544003u;
        }
        case 214u: {
            return 84544004u;
        }
        default: {
            break;
        }
    }
    return 0u;
}

uint smsr_arm(
    uint key
) {
    uint _e3 = smsr_lookup(key >> 2u);
    return (_e3 >> ((key & 3u) * 8u)) & 255u;
}

SmsrResult smsr_key_case(
    uint key_1,
    float dH,
    float dV,
    float px,
    float py
) {
    uint H_3 = key_1 & 3u;
    uint V_3 = (key_1 >> 2u) & 3u;
    uint _e11 = smsr_arm(key_1);
    switch(_e11) {
        case 0u: {
            return SmsrResult {1.0, 1u};
        }
        case 1u: {
            return SmsrResult {1.0, 4294967295u};
        }
        case 2u: {
            return SmsrResult {0.0, 2u};
        }
        case 3u: {
            if (py < dH) {
                return SmsrResult {0.0, 10u};
            }
            return SmsrResult {1.0, 10u};
        }
        case 4u: {
            if ((1.0 - py) < dH) {
                return SmsrResult {0.0, 9u};
            }
            return SmsrResult {1.0, 9u};
        }
        case 5u: {
            return SmsrResult {0.0, 3u};
        }
        case 6u: {
            if ((1.0 - px) < dV) {
                return SmsrResult {0.0, 12u};
            }
            return SmsrResult {1.0, 12u};
        }
        case 7u: {
            if ((1.0 - dH) < (1.0 - py)) {
                return SmsrResult {0.0, 7u};
            }
            return SmsrResult {1.0, 7u};
        }
        case 8u: {
            return SmsrResult {(V_3 == SMSR_V_BOTTOM) ? (((1.0 - py) < dH) ? 0.0 : 1.0) : ((py < dH) ? 0.0 : 1.0), 5u};
        }
        case 9u: {
            return SmsrResult {(H_3 == SMSR_H_LEFT) ? ((px < dV) ? 0.0 : 1.0) : (((1.0 - px) < dV) ? 0.0 : 1.0), 4u};
        }
        case 10u: {
            return SmsrResult {metal::min((V_3 == SMSR_V_BOTTOM) ? (((1.0 - py) < dH) ? 0.0 : 1.0) : ((py < dH) ? 0.0 : 1.0), (H_3 == SMSR_H_LEFT) ? ((px < dV) ? 0.0 : 1.0) : (((1.0 - px) < dV) ? 0.0 : 1.0)), 8u};
        }
        case 11u: {
            if ((1.0 - dH) < py) {
                return SmsrResult {0.0, 6u};
            }
            return SmsrResult {1.0, 6u};
        }
        default: {
            break;
        }
    }
    if (px < dV) {
        return SmsrResult {0.0, 11u};
    }
    return SmsrResult {1.0, 11u};
}

float smsr_key(
    uint key_2,
    float dH_1,
    float dV_1,
    float px_1,
    float py_1
) {
    SmsrResult _e5 = smsr_key_case(key_2, dH_1, dV_1, px_1, py_1);
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
