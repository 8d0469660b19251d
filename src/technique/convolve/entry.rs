//! Convolution shadows, and their reference, as techniques.

#[cfg(feature = "gpu")]
use std::rc::Rc;

#[cfg(feature = "gpu")]
use super::gpu::Device;
use super::picture::{Picture, picture};
use super::settings::{self as set, Chosen};
use crate::diag::{Diagnostic, Failure, codes};
#[cfg(feature = "gpu")]
use crate::gpu::timing::Stopwatch;
use crate::scene::light::Lights;
#[cfg(feature = "gpu")]
use crate::technique::Executor;
#[cfg(feature = "gpu")]
use crate::technique::prepared::{Detail, Pass};
use crate::technique::rendered::LIGHT;
use crate::technique::setting::SEED;
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

static TABLES: [&BuiltIn; 7] = [
    &tables::POLICIES,
    &tables::SLAB,
    &tables::ELLIPSE,
    &tables::KERNELS,
    &tables::LIGHT_KERNEL,
    &tables::SHADE,
    &tables::NOISE,
];

static SETTINGS: [Setting; 20] = [
    set::SLABS,
    set::DISTANCE,
    set::KERNEL,
    set::SAMPLES,
    set::PHASE,
    SEED,
    set::SMEAR,
    set::COVERAGE,
    set::HIT,
    set::RULE,
    set::ODD,
    set::BORDER,
    set::PROJECTION,
    set::SPLIT,
    set::RHO,
    set::FRAMES,
    set::DETAIL,
    set::SLOPES,
    set::SKIP,
    set::PRECISION,
];

static REFERENCE_SETTINGS: [Setting; 11] = [
    set::SLABS,
    set::DETAIL,
    SEED,
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
            "light of distant Gaussians in slabs, by iterated blurs"
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
        &[Ability::Passes]
    }

    fn truth(&self) -> Option<&'static str> {
        (!self.is_reference).then_some(REFERENCE_NAME)
    }

    fn needs_device(&self) -> bool {
        !self.is_reference
    }

    fn prepare<'s>(&self, frame: &Frame<'s>) -> Result<Box<dyn Prepared<'s> + 's>, Failure> {
        let machine = match frame.on {
            #[cfg(feature = "gpu")]
            Executor::Gpu(gpu) if !self.is_reference => Machine::Gpu(Box::new(Device::new(gpu, frame.scene)?)),
            _ => Machine::Cpu,
        };
        let slabs = Slabs { is_reference: self.is_reference, machine, frame: frame.clone() };
        slabs.chosen()?;
        Ok(Box::new(slabs))
    }
}

/// The machine that sweeps.
enum Machine<'s> {
    /// Plain Rust, with the tables by the interpreter.
    Cpu,
    #[cfg(feature = "gpu")]
    Gpu(Box<Device<'s>>),
    #[cfg(not(feature = "gpu"))]
    #[expect(dead_code, reason = "keeps the lifetime in builds without GPU support")]
    Never(&'s std::convert::Infallible),
}

/// A frame to be swept.
struct Slabs<'s> {
    is_reference: bool,
    machine: Machine<'s>,
    frame: Frame<'s>,
}

impl Slabs<'_> {
    /// The choices for the frame.
    fn chosen(&self) -> Result<Chosen, Failure> {
        let settings = &self.frame.settings;
        let chosen = if self.is_reference { Chosen::of_reference(settings) } else { Chosen::of(settings) };
        if chosen.wide && !matches!(self.machine, Machine::Cpu) {
            let error = Diagnostic::error(codes::RENDER, "devices keep light in single precision");
            let help = "leave out `--set precision=f64`, or render with `--backend cpu`";
            return Err(Failure::bare("", error.help(help)));
        }
        Ok(chosen)
    }

    fn picture(&self) -> Result<Picture, Failure> {
        let chosen = self.chosen()?;
        match &self.machine {
            Machine::Cpu => picture(&self.frame, &chosen),
            #[cfg(feature = "gpu")]
            Machine::Gpu(device) => device.picture(&self.frame, &chosen),
            #[cfg(not(feature = "gpu"))]
            Machine::Never(never) => match **never {},
        }
    }
}

impl<'s> Prepared<'s> for Slabs<'s> {
    fn render(&mut self, progress: &Progress<'_>) -> Result<Rendered, Failure> {
        let Picture { mut light, opacity, crossings, odd } = self.picture()?;
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
        #[cfg(feature = "gpu")]
        if let (Machine::Gpu(device), Executor::Gpu(gpu)) = (&self.machine, frame.on)
            && !device.fits(frame.scene)
        {
            self.machine = Machine::Gpu(Box::new(Device::new(gpu, frame.scene)?));
        }
        self.chosen().map(drop)
    }

    #[cfg(feature = "gpu")]
    fn passes(&mut self, _: Detail) -> Result<Vec<Pass<'_>>, Failure> {
        let own = &*self;
        let name = if own.is_reference { REFERENCE_NAME } else { NAME };
        Ok(match &own.machine {
            Machine::Cpu => vec![Pass::on_cpu(name, "picture", move || own.picture().map(drop))],
            Machine::Gpu(device) => {
                let ready = Rc::new(device.ready(&own.frame, &own.chosen()?)?);
                let again = Rc::clone(&ready);
                vec![
                    Pass::new(name, "layers", None, move |watch: &Stopwatch<'_>| device.time_layers(&ready, watch)),
                    Pass::new(name, "sweep", None, move |watch: &Stopwatch<'_>| device.time_sweep(&again, watch)),
                ]
            }
        })
    }
}
