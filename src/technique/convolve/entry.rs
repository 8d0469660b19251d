//! Convolution shadows, and their reference, as techniques.

use super::picture::{Picture, picture};
use super::settings::{self as set, Chosen};
use crate::diag::Failure;
use crate::scene::light::Lights;
use crate::technique::rendered::LIGHT;
use crate::technique::tables::{self, BuiltIn};
use crate::technique::{Ability, Frame, Prepared, Progress, Rendered, Samples, Setting, Technique};

/// The technique's name.
const NAME: &str = "convolve";
/// The name of its reference.
const REFERENCE_NAME: &str = "convolve_reference";

/// Layer of opacities.
pub const OPACITY: &str = "opacity";
/// Layer of the surfaces that rays through pixels cross.
pub const CROSSINGS: &str = "crossings";
/// Layer of pixels at which a surface is entered and never left.
pub const ODD_LISTS: &str = "odd";

static TABLES: [&BuiltIn; 6] =
    [&tables::POLICIES, &tables::SLAB, &tables::ELLIPSE, &tables::KERNELS, &tables::LIGHT_KERNEL, &tables::SHADE];

static SETTINGS: [Setting; 16] = [
    set::SLABS,
    set::DISTANCE,
    set::KERNEL,
    set::SAMPLES,
    set::PHASE,
    set::SMEAR,
    set::COVERAGE,
    set::HIT,
    set::RULE,
    set::ODD,
    set::BORDER,
    set::PROJECTION,
    set::SPLIT,
    set::RHO,
    set::SKIP,
    set::PRECISION,
];

static REFERENCE_SETTINGS: [Setting; 9] = [
    set::SLABS,
    set::COVERAGE,
    set::HIT,
    set::RULE,
    set::ODD,
    set::BORDER,
    set::PROJECTION,
    set::PRECISION,
    set::SHARP_LIGHTS,
];

/// Convolution shadows or their reference.
#[derive(Debug)]
pub struct Entry {
    is_reference: bool,
}

/// Light spread by iterated blurs.
pub static CONVOLVE: Entry = Entry { is_reference: false };
/// The same slabs under many sharp lights.
pub static REFERENCE: Entry = Entry { is_reference: true };

impl Technique for Entry {
    fn name(&self) -> &'static str {
        if self.is_reference { REFERENCE_NAME } else { NAME }
    }

    fn doc(&self) -> &'static str {
        if self.is_reference {
            "light of distant Gaussians in slabs, each as many sharp lights, on the CPU: the truth of convolve"
        } else {
            "light of distant Gaussians in slabs, by iterated blurs, on the CPU"
        }
    }

    fn tables(&self) -> &'static [&'static BuiltIn] {
        &TABLES
    }

    fn lights(&self) -> Lights {
        Lights::GAUSSIAN
    }

    fn settings(&self) -> &'static [Setting] {
        if self.is_reference { &REFERENCE_SETTINGS } else { &SETTINGS }
    }

    fn abilities(&self) -> &'static [Ability] {
        &[]
    }

    fn truth(&self) -> Option<&'static str> {
        (!self.is_reference).then_some(REFERENCE_NAME)
    }

    fn needs_device(&self) -> bool {
        false
    }

    fn prepare<'s>(&self, frame: &Frame<'s>) -> Result<Box<dyn Prepared<'s> + 's>, Failure> {
        Ok(Box::new(Slabs { is_reference: self.is_reference, frame: frame.clone() }))
    }
}

/// A frame to be swept.
struct Slabs<'s> {
    is_reference: bool,
    frame: Frame<'s>,
}

impl<'s> Prepared<'s> for Slabs<'s> {
    fn render(&mut self, progress: &Progress<'_>) -> Result<Rendered, Failure> {
        let settings = &self.frame.settings;
        let chosen = if self.is_reference { Chosen::of_reference(settings) } else { Chosen::of(settings) };
        let Picture { mut light, opacity, crossings, odd } = picture(&self.frame, &chosen)?;
        let background = self.frame.scene.background.map(|channel| channel as f32);
        for (pixel, opacity) in light.iter_mut().zip(&opacity) {
            pixel.iter_mut().zip(background).for_each(|(channel, behind)| *channel += (1.0 - opacity) * behind);
        }
        progress(u64::from(self.frame.size().1));
        Ok(Rendered::default()
            .with(LIGHT, Samples::Colours(light))
            .with(OPACITY, Samples::Numbers(opacity))
            .with(CROSSINGS, Samples::Counts(crossings))
            .with(ODD_LISTS, Samples::Counts(odd)))
    }

    fn set_frame(&mut self, frame: &Frame<'s>) -> Result<(), Failure> {
        self.frame = frame.clone();
        Ok(())
    }
}
