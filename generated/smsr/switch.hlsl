struct SmsrResult {
    float value;
    uint case_id;
};

static const uint SMSR_H_NONE = 0u;
static const uint SMSR_H_RIGHT = 1u;
static const uint SMSR_H_LEFT = 2u;
static const uint SMSR_H_BOTH = 3u;
static const uint SMSR_V_NONE = 0u;
static const uint SMSR_V_TOP = 1u;
static const uint SMSR_V_BOTTOM = 2u;
static const uint SMSR_V_BOTH = 3u;
static const uint SMSR_TH_DUAL_NEGATIVE = 0u;
static const uint SMSR_TH_POSITIVE_NEGATIVE = 1u;
static const uint SMSR_TH_DUAL_POSITIVE = 2u;
static const uint SMSR_DEFAULT = 4294967295u;

ByteAddressBuffer umbrage_plain : register(t0);
RWByteAddressBuffer umbrage_out : register(u2);

uint smsr_H_level(float code)
{
    return ((uint((code >= 0.125)) + uint((code >= 0.375))) + uint((code >= 0.625)));
}

uint smsr_V_level(float code_1)
{
    return ((uint((code_1 >= 0.125)) + uint((code_1 >= 0.375))) + uint((code_1 >= 0.625)));
}

uint smsr_tH_level(float code_2)
{
    return (uint((code_2 >= -0.5)) + uint((code_2 >= 0.5)));
}

uint smsr_pack(float H, float V, float tH, float tV, bool domH, bool domV)
{
    const uint _e6 = smsr_H_level(H);
    const uint _e7 = smsr_V_level(V);
    const uint _e11 = smsr_tH_level(tH);
    const uint _e15 = smsr_tH_level(tV);
    return (((((_e6 | (_e7 << 2u)) | (_e11 << 4u)) | (_e15 << 6u)) | (uint(domH) << 8u)) | (uint(domV) << 9u));
}

uint smsr_lookup(uint word)
{
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

uint smsr_arm(uint key)
{
    const uint _e3 = smsr_lookup((key >> 2u));
    return ((_e3 >> ((key & 3u) * 8u)) & 255u);
}

SmsrResult ConstructSmsrResult(float arg0, uint arg1) {
    SmsrResult ret = (SmsrResult)0;
    ret.value = arg0;
    ret.case_id = arg1;
    return ret;
}

SmsrResult smsr_key_case(uint key_1, float dH, float dV, float px, float py)
{
    uint H_3 = (key_1 & 3u);
    uint V_3 = ((key_1 >> 2u) & 3u);
    const uint _e11 = smsr_arm(key_1);
    switch(_e11) {
        case 0u: {
            const SmsrResult smsrresult = ConstructSmsrResult(1.0, 1u);
            return smsrresult;
        }
        case 1u: {
            const SmsrResult smsrresult_1 = ConstructSmsrResult(1.0, 4294967295u);
            return smsrresult_1;
        }
        case 2u: {
            const SmsrResult smsrresult_2 = ConstructSmsrResult(0.0, 2u);
            return smsrresult_2;
        }
        case 3u: {
            if ((py < dH)) {
                const SmsrResult smsrresult_3 = ConstructSmsrResult(0.0, 10u);
                return smsrresult_3;
            }
            const SmsrResult smsrresult_4 = ConstructSmsrResult(1.0, 10u);
            return smsrresult_4;
        }
        case 4u: {
            if (((1.0 - py) < dH)) {
                const SmsrResult smsrresult_5 = ConstructSmsrResult(0.0, 9u);
                return smsrresult_5;
            }
            const SmsrResult smsrresult_6 = ConstructSmsrResult(1.0, 9u);
            return smsrresult_6;
        }
        case 5u: {
            const SmsrResult smsrresult_7 = ConstructSmsrResult(0.0, 3u);
            return smsrresult_7;
        }
        case 6u: {
            if (((1.0 - px) < dV)) {
                const SmsrResult smsrresult_8 = ConstructSmsrResult(0.0, 12u);
                return smsrresult_8;
            }
            const SmsrResult smsrresult_9 = ConstructSmsrResult(1.0, 12u);
            return smsrresult_9;
        }
        case 7u: {
            if (((1.0 - dH) < (1.0 - py))) {
                const SmsrResult smsrresult_10 = ConstructSmsrResult(0.0, 7u);
                return smsrresult_10;
            }
            const SmsrResult smsrresult_11 = ConstructSmsrResult(1.0, 7u);
            return smsrresult_11;
        }
        case 8u: {
            const SmsrResult smsrresult_12 = ConstructSmsrResult(((V_3 == SMSR_V_BOTTOM) ? (((1.0 - py) < dH) ? 0.0 : 1.0) : ((py < dH) ? 0.0 : 1.0)), 5u);
            return smsrresult_12;
        }
        case 9u: {
            const SmsrResult smsrresult_13 = ConstructSmsrResult(((H_3 == SMSR_H_LEFT) ? ((px < dV) ? 0.0 : 1.0) : (((1.0 - px) < dV) ? 0.0 : 1.0)), 4u);
            return smsrresult_13;
        }
        case 10u: {
            const SmsrResult smsrresult_14 = ConstructSmsrResult(min(((V_3 == SMSR_V_BOTTOM) ? (((1.0 - py) < dH) ? 0.0 : 1.0) : ((py < dH) ? 0.0 : 1.0)), ((H_3 == SMSR_H_LEFT) ? ((px < dV) ? 0.0 : 1.0) : (((1.0 - px) < dV) ? 0.0 : 1.0))), 8u);
            return smsrresult_14;
        }
        case 11u: {
            if (((1.0 - dH) < py)) {
                const SmsrResult smsrresult_15 = ConstructSmsrResult(0.0, 6u);
                return smsrresult_15;
            }
            const SmsrResult smsrresult_16 = ConstructSmsrResult(1.0, 6u);
            return smsrresult_16;
        }
        default: {
            break;
        }
    }
    if ((px < dV)) {
        const SmsrResult smsrresult_17 = ConstructSmsrResult(0.0, 11u);
        return smsrresult_17;
    }
    const SmsrResult smsrresult_18 = ConstructSmsrResult(1.0, 11u);
    return smsrresult_18;
}

float smsr_key(uint key_2, float dH_1, float dV_1, float px_1, float py_1)
{
    const SmsrResult _e5 = smsr_key_case(key_2, dH_1, dV_1, px_1, py_1);
    return _e5.value;
}

SmsrResult smsr_case(float H_1, float V_1, float tH_1, float tV_1, float dH_2, float dV_2, float px_2, float py_2, bool domH_1, bool domV_1)
{
    const uint _e10 = smsr_pack(H_1, V_1, tH_1, tV_1, domH_1, domV_1);
    const SmsrResult _e11 = smsr_key_case(_e10, dH_2, dV_2, px_2, py_2);
    const SmsrResult smsrresult_19 = _e11;
    return smsrresult_19;
}

float smsr(float H_2, float V_2, float tH_2, float tV_2, float dH_3, float dV_3, float px_3, float py_3, bool domH_2, bool domV_2)
{
    const SmsrResult _e10 = smsr_case(H_2, V_2, tH_2, tV_2, dH_3, dV_3, px_3, py_3, domH_2, domV_2);
    return _e10.value;
}

[numthreads(64, 1, 1)]
void smsr_columns(uint3 id : SV_DispatchThreadID)
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
    const SmsrResult _e39 = smsr_key_case(_e14, asfloat(_e19), asfloat(_e25), asfloat(_e31), asfloat(_e37));
    umbrage_out.Store(((row * 2u) + 0u)*4, asuint(_e39.case_id));
    umbrage_out.Store(((row * 2u) + 1u)*4, asuint(asuint(_e39.value)));
    return;
}
