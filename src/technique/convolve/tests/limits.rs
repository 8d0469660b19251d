//! The ends of what can be asked for: lights that are points or lines, pictures of a pixel, no matter, no light, meshes
//! without volume, surfaces that coincide, and what is refused.

use super::super::layers::Layers;
use super::super::settings as set;
use super::super::view::{Projection, SlabView};
use super::super::{CONVOLVE, CROSSINGS, ODD_LISTS, OPACITY};
use super::scenes::{LAMP, rendered, scene, slabs, tried};
use crate::technique::rendered::LIGHT;
use crate::technique::setting::Value;
use crate::technique::{Executor, Frame, Rendered, Settings, read_settings};

const PLATE: &str = "(shape: Block(size: (9, 0.2, 9)))";
const BLOCK: &str = "(shape: Block(size: (1, 0.1, 1)), at: (0, 1.5, 0))";

fn light(picture: &Rendered) -> &[[f32; 3]] {
    picture.colours(LIGHT).expect("a layer")
}

fn is_sane(picture: &Rendered) -> bool {
    let opacities = picture.numbers(OPACITY).expect("a layer");
    light(picture).iter().flatten().all(|channel| (0.0..=1.01).contains(channel))
        && opacities.iter().all(|opacity| (0.0..=1.0).contains(opacity))
}

/// A light that is a point has a sharp shadow with every kernel, and one that is a line no shadow that is not a number.
#[test]
fn lights_that_are_points_or_lines() {
    let objects = format!("{PLATE}, {BLOCK}");
    let sharp = scene("Gaussian(tilts: (20, 0), deviations: (0, 0))", &objects);
    let line = scene("Gaussian(tilts: (20, 0), deviations: (0.5, 0), rotation: 30)", &objects);
    for kernel in ["ring_affine", "ring_arc", "poisson8", "poisson16", "gauss19x19", "frac_box", "binomial3"] {
        let settings = slabs(24).with(&set::KERNEL, Value::Word(kernel));
        let picture = rendered(&sharp, settings.clone());
        assert!(light(&picture).iter().flatten().all(|channel| *channel == 0.0 || *channel > 0.7), "{kernel}");
        assert!(is_sane(&rendered(&line, settings)), "{kernel}");
    }
}

#[test]
fn offsets_larger_than_the_picture_see_light() {
    let wide = scene("Gaussian(tilts: (79, 0), deviations: (50, 50))", &format!("{PLATE}, {BLOCK}"));
    let picture = rendered(&wide, slabs(3));
    assert!(is_sane(&picture) && light(&picture).iter().all(|pixel| pixel[0] > 0.5));
}

/// A flat mesh that is closed: a slab of matter where it is seen, or nothing, as the coverage has it.
#[test]
fn a_mesh_without_volume() {
    let [there, back] =
        ["(-1, 1, -1), (-1, 1, 1), (1, 1, 1), (1, 1, -1)", "(1, 1, -1), (1, 1, 1), (-1, 1, 1), (-1, 1, -1)"];
    let sheet = format!("(shape: Polygon(corners: [{there}])), (shape: Polygon(corners: [{back}]))");
    let scene = scene(LAMP, &format!("{PLATE}, {sheet}"));
    let middle = 20 * 48 + 24;
    for (coverage, opaque) in [("full", true), ("exact", false)] {
        let settings = slabs(16).with(&set::COVERAGE, Value::Word(coverage)).with(&set::RULE, Value::Word("winding"));
        let picture = rendered(&scene, settings);
        assert_eq!(picture.counts(CROSSINGS).expect("a layer")[middle], 4, "{coverage}");
        assert_eq!(picture.counts(ODD_LISTS).expect("a layer").iter().sum::<u32>(), 0, "{coverage}");
        let shadow = light(&picture)[middle][0] < 0.5;
        assert!(!shadow || !opaque, "the sheet is seen, or the plate without a shadow");
        assert!(is_sane(&picture), "{coverage}");
    }
}

/// Walls that are seen edge-on leave no trace in the lists: as many surfaces are entered as are left.
#[test]
fn surfaces_seen_edge_on() {
    let scene = scene(LAMP, "(shape: Block(size: (2, 1, 2)))");
    let view = SlabView::new(&scene, (48, 40), Projection::Orthographic);
    let layers = Layers::new(&scene, &view).expect("few");
    assert!((0..48 * 40).all(|pixel| [0, 2].contains(&layers.of(pixel).len())));
}

/// The same object twice is the object once, by winding and in pictures of what there is.
#[test]
fn surfaces_that_coincide() {
    let winding = |objects: &str| {
        let settings = slabs(20).with(&set::RULE, Value::Word("winding")).with(&set::COVERAGE, Value::Word("exact"));
        rendered(&scene(LAMP, objects), settings)
    };
    let (once, twice) = (winding(&format!("{PLATE}, {BLOCK}")), winding(&format!("{PLATE}, {BLOCK}, {BLOCK}")));
    assert_eq!(light(&once), light(&twice));
}

/// Every closed shape is inside of itself, whichever rule says what that is.
#[test]
fn shapes_are_the_same_by_both_rules() {
    for shape in ["Block(size: (1, 1, 1))", "Ball(radius: 0.6)", "Cylinder(radius: 0.5, height: 1)"] {
        let scene = scene(LAMP, &format!("(shape: {shape}, turn: (30, 20, 10))"));
        let [parity, winding] =
            ["parity", "winding"].map(|rule| rendered(&scene, slabs(20).with(&set::RULE, Value::Word(rule))));
        assert_eq!(light(&parity), light(&winding), "{shape}");
        assert!(light(&parity).iter().any(|pixel| pixel[0] > 0.3), "{shape}");
    }
}

/// Behind what absorbs everything light is 0, and not less.
#[test]
fn behind_opaque_matter_there_is_no_light() {
    let sharp = scene("Gaussian(tilts: (0, 0), deviations: (0, 0))", &format!("{PLATE}, {BLOCK}"));
    let picture = rendered(&sharp, slabs(16).with(&set::HIT, Value::Word("last")));
    assert!(is_sane(&picture));
    let tilted = scene("Gaussian(tilts: (45, 0), deviations: (0, 0))", &format!("{PLATE}, {BLOCK}"));
    assert!(light(&rendered(&tilted, slabs(16))).contains(&[0.0; 3]));
}

/// A light of no strength is left out: matter is black, and as opaque as ever.
#[test]
fn without_light_matter_is_black() {
    let dark = scene("Gaussian(tilts: (0, 0), deviations: (0.3, 0.3), colour: (0, 0, 0))", PLATE);
    let picture = rendered(&dark, slabs(16));
    assert!(light(&picture).iter().all(|pixel| *pixel == [0.0; 3]));
    assert!(picture.numbers(OPACITY).expect("a layer").contains(&1.0));
}

#[test]
fn a_picture_of_one_pixel_and_very_many_slabs() {
    let thin = "(shape: Block(size: (9, 0.00001, 9)))";
    let scene = scene(LAMP, &format!("{thin}, {}", thin.replace(")))", ")), at: (0, 1, 0))")));
    let settings = slabs(1 << 20);
    let frame = Frame::new(&scene, (1, 1), &Executor::Cpu).with(settings);
    let picture = frame.prepare(&CONVOLVE).and_then(|mut ready| ready.render(&|_| {})).expect("a pixel");
    assert_eq!(light(&picture), [[0.75; 3]]);
}

#[test]
fn settings_out_of_range_are_named() {
    for (pair, said) in [
        ("slabs=0", "`0` is no value of the setting `slabs`"),
        ("slabs=1048577", "`1048577` is no value of the setting `slabs`"),
        ("distance=-1", "`-1` is no value of the setting `distance`"),
        ("distance=nan", "`nan` is no value of the setting `distance`"),
        ("rho=2", "`2` is no value of the setting `rho`"),
        ("samples=1", "`1` is no value of the setting `samples`"),
        ("kernel=disc", "`disc` is no value of the setting `kernel`"),
    ] {
        let error = read_settings(&[&CONVOLVE], [pair]).expect_err("refused").to_string();
        assert!(error.contains(said), "{pair}: {error}");
    }
}

#[test]
fn what_does_not_go_together_is_refused() {
    let objects = format!("{PLATE}, {BLOCK}");
    let said =
        |settings: Settings| tried(&scene(LAMP, &objects), &CONVOLVE, settings).expect_err("refused").to_string();
    let drawn = slabs(9).with(&set::PHASE, Value::Word("pixel"));
    let drawn = said(drawn.with(&set::PROJECTION, Value::Word("perspective_world")));
    assert!(drawn.contains("phases drawn for each pixel are for views without magnification"), "{drawn}");
    let wide = scene("Gaussian(tilts: (0, 0), deviations: (90, 90))", &objects);
    let settings = slabs(2).with(&set::KERNEL, Value::Word("frac_box")).with(&set::SKIP, Value::Whole(0));
    let error = tried(&wide, &CONVOLVE, settings).expect_err("refused").to_string();
    assert!(error.contains("`frac_box` is made for variances up to 300 square pixels"), "{error}");
}
