//! The settings of the variants, declared, and read from a frame.

use super::Settings;
use super::stage::Bias;
use crate::technique::setting::{Range, Value};
use crate::technique::{Frame, Setting};

/// Largest side of a shadow map.
pub const MAX_MAP: u32 = 16384;

/// Texels per side of the shadow map.
pub const SHADOW_MAP: Setting = Setting {
    name: "shadow_map",
    doc: "texels per side of the shadow map",
    default: Value::Whole(1024),
    range: Range::Whole(1, MAX_MAP),
    label: "map",
};

/// [`Bias::constant`]
pub const BIAS: Setting = Setting {
    name: "bias",
    doc: "depth bias, in units of 2^-22 of the light's range",
    default: Value::Number(Bias::DEFAULT.constant as f64),
    range: Range::Number(0.0, 1e6),
    label: "",
};

/// [`Bias::slope`]
pub const SLOPE_BIAS: Setting = Setting {
    name: "slope_bias",
    doc: "depth bias, times the slope of the surface",
    default: Value::Number(Bias::DEFAULT.slope as f64),
    range: Range::Number(0.0, 1e6),
    label: "",
};

/// [`Settings::search_limit`]
pub const SEARCH_LIMIT: Setting = Setting {
    name: "search_limit",
    doc: "longest run that is revectorised, in texels",
    default: Value::Whole(Settings::DEFAULT.search_limit),
    range: Range::Whole(1, 4096),
    label: "search limit",
};

/// [`Settings::walk_bias`]
pub const WALK_BIAS: Setting = Setting {
    name: "walk_bias",
    doc: "depth bias along walks, as a share of the light's range",
    default: Value::Number(Settings::DEFAULT.walk_bias as f64),
    range: Range::Number(0.0, 1e6),
    label: "",
};

/// [`Settings::pcf`]
pub const PCF_KERNEL: Setting = Setting {
    name: "pcf",
    doc: "side of the kernel, in texels",
    default: Value::Whole(Settings::DEFAULT.pcf),
    range: Range::Odd(1, 31),
    label: "",
};

/// The code shape of the table on a GPU.
pub const PLAN: Setting = Setting {
    name: "plan",
    doc: "code shape of the table on a GPU",
    default: Value::Plan(crate::plan::Shape::Ladder),
    range: Range::Plan,
    label: "",
};

/// The depth bias of a frame.
pub(super) fn bias(frame: &Frame<'_>) -> Bias {
    let [constant, slope] = [&BIAS, &SLOPE_BIAS].map(|setting| frame.settings.number(setting) as f32);
    Bias { constant, slope }
}

/// The settings of search and filter in a frame.
pub(super) fn settings(frame: &Frame<'_>) -> Settings {
    Settings {
        search_limit: frame.settings.whole(&SEARCH_LIMIT),
        walk_bias: frame.settings.number(&WALK_BIAS) as f32,
        pcf: frame.settings.whole(&PCF_KERNEL),
    }
}
