//! A picture: layers, slabs, lights and steps of a scene put together, and swept.

use std::sync::Arc;

use super::dither::Dither;
use super::fine::Fine;
use super::inside::Changes;
use super::layers::Layers;
use super::light::{SlopeLight, nodes};
use super::material::Material;
use super::matter::SceneSlabs;
use super::settings::Chosen;
use super::stack::Stack;
use super::stencil::Real;
use super::steps::{Spread, Steps};
use super::surface::{Slope, Surfaces};
use super::sweep::{Seen, Sweep};
use super::view::SlabView;
use crate::diag::{Diagnostic, Failure, codes};
use crate::scene::{Object, Scene};
use crate::technique::Frame;

/// The most memory for light images, in bytes: parts of split lights beyond it wait for the next sweep.
const MOST_LIGHT: usize = 1 << 30;

/// The surfaces that a frame's pixels cross: the same for all ways to light it.
#[derive(Debug)]
pub struct Crossed {
    view: SlabView,
    changes: Changes,
    /// Crossings of each pixel.
    counts: Vec<u32>,
    /// The nearest and the farthest surface; `None` where nothing is seen.
    depths: Option<(f32, f32)>,
    /// The depth that depths are relative to.
    base: f64,
}

/// The result of a frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Picture {
    /// Light that comes to the viewer, without the background's.
    pub light: Vec<[f32; 3]>,
    /// Opacity.
    pub opacity: Vec<f32>,
    /// Surfaces that the ray through a pixel crosses.
    pub crossings: Vec<u32>,
    /// Pixels at which a surface is entered and never left, with 1.
    pub odd: Vec<u32>,
}

impl Crossed {
    /// The crossings of a frame.
    ///
    /// # Errors
    /// When there are too many, or some that are not allowed.
    pub fn of(frame: &Frame<'_>, chosen: &Chosen) -> Result<Arc<Self>, Failure> {
        frame.shared(("convolve", chosen.projection, chosen.inside), || {
            let view = SlabView::new(frame.scene, frame.size(), chosen.projection);
            let layers = Layers::new(frame.scene, &view)?;
            let counts = layers.first.windows(2).map(|ends| (ends[1] - ends[0]) as u32).collect();
            let changes = Changes::new(&layers, chosen.inside)?;
            Ok(Self { view, changes, counts, depths: layers.depths(), base: layers.base })
        })
    }

    /// The slabs that hold everything that is seen: the farthest surface lies before the end of the last one.
    pub fn stack(&self, count: usize) -> Option<Stack> {
        Some(Stack::holding(self.base, self.depths?, count))
    }
}

/// The materials of a scene's objects.
pub(super) fn materials(scene: &Scene) -> Vec<Material> {
    let material = |object: &Object| Material {
        colour: object.colour,
        matter: object.matter,
        shine: object.shine,
        detail: object.detail.clone(),
    };
    scene.objects.iter().map(material).collect()
}

/// The distance at which penumbras are right: as chosen, or half of the depth of all slabs.
pub(super) fn d1_for(chosen: &Chosen, stack: &Stack) -> f64 {
    if chosen.spread.d1 > 0.0 { chosen.spread.d1 } else { 0.5 * stack.thickness * stack.count() as f64 }
}

/// The surfaces of a picture under some lights.
pub(super) fn surfaces(
    lights: &[SlopeLight],
    materials: &[Material],
    chosen: &Chosen,
    stack: &Stack,
) -> Result<Surfaces, Failure> {
    let slope = chosen.compensates.then(|| Slope::new(stack.thickness, d1_for(chosen, stack))).transpose()?;
    Surfaces::new(lights, materials, slope)
}

/// The lights of a picture, divided into those that are swept together: pictures of all portions add up.
#[derive(Debug)]
pub(super) struct Portions(Vec<Vec<SlopeLight>>);

impl Portions {
    /// All parts of all lights together; or frame by frame one part of each, the next one in each frame.
    ///
    /// # Errors
    /// When a light cannot be used.
    pub(super) fn new(scene: &Scene, view: &SlabView, chosen: &Chosen) -> Result<Self, Failure> {
        let nodes = nodes(chosen.split.lights)?;
        let lights = SlopeLight::of_scene(scene, view)?;
        let parts: Vec<Vec<SlopeLight>> = lights.iter().map(|light| light.split(&nodes, chosen.split.rho)).collect();
        if chosen.frames == 0 {
            return Ok(Self(vec![parts.concat()]));
        }
        // A part stands for the whole light in its frame.
        let share = nodes.len() as f64 / f64::from(chosen.frames);
        let frame = |frame: u32| {
            let part = |parts: &Vec<SlopeLight>| {
                let part = parts[frame as usize % parts.len()];
                SlopeLight { colour: part.colour.map(|channel| channel * share), ..part }
            };
            parts.iter().map(part).collect()
        };
        Ok(Self((0..chosen.frames).map(frame).collect()))
    }

    /// The same with at most so many lights in each portion.
    pub(super) fn of_at_most(self, most: usize) -> Vec<Vec<SlopeLight>> {
        let cut = |lights: Vec<SlopeLight>| match lights.len() {
            0 => vec![lights],
            _ => lights.chunks(most).map(<[SlopeLight]>::to_vec).collect(),
        };
        self.0.into_iter().flat_map(cut).collect()
    }
}

/// Renders a frame on the CPU.
///
/// # Errors
/// When a light or a kernel cannot be used.
pub fn picture(frame: &Frame<'_>, chosen: &Chosen) -> Result<Picture, Failure> {
    let crossed = Crossed::of(frame, chosen)?;
    let portions = Portions::new(frame.scene, &crossed.view, chosen)?;
    let (light, opacity) = match crossed.stack(chosen.slabs) {
        None => {
            let pixels = crossed.counts.len();
            (vec![[0.0; 3]; pixels], vec![0.0; pixels])
        }
        Some(stack) if chosen.wide => swept::<f64>(frame.scene, &crossed, &stack, portions, chosen)?,
        Some(stack) => swept::<f32>(frame.scene, &crossed, &stack, portions, chosen)?,
    };
    let odd = crossed.changes.odd.iter().map(|odd| u32::from(*odd)).collect();
    Ok(Picture { light, opacity, crossings: crossed.counts.clone(), odd })
}

/// Colours and opacities of pixels.
type Pixels = (Vec<[f32; 3]>, Vec<f32>);

/// Sweeps as many lights at once as there is memory for.
fn swept<T: Real>(
    scene: &Scene,
    crossed: &Crossed,
    stack: &Stack,
    portions: Portions,
    chosen: &Chosen,
) -> Result<Pixels, Failure> {
    let (width, height) = (crossed.view.size.0 as usize, crossed.view.size.1 as usize);
    let materials = materials(scene);
    let fine = Fine::new(&materials, &crossed.view, crossed.base, chosen.spread.seed, chosen.integrates)?;
    let slabs = SceneSlabs::new(&crossed.changes, stack, width, chosen.policies, materials.clone(), fine)?;
    let spread = Spread { d1: d1_for(chosen, stack), ..chosen.spread };
    let occupied = slabs.occupied();
    let of_one = 2 * 3 * width * height * size_of::<T>();
    if of_one > 8 * MOST_LIGHT {
        let message = format!("the images of one light would take {} MiB", of_one >> 20);
        return Err(Failure::bare("", Diagnostic::error(codes::RENDER, message).help("make the picture smaller")));
    }
    let mut sum: Option<Seen<T>> = None;
    let mut dither = Dither::new((width, height))?;
    for portion in portions.of_at_most((MOST_LIGHT / of_one).max(1)) {
        let steps = Steps::<T>::new(&portion, stack, &occupied, &spread, &crossed.view)?;
        let colours = portion.iter().map(|light| light.colour).collect();
        let surfaces = surfaces(&portion, &materials, chosen, stack)?;
        let mut sweep = Sweep::<_, T>::new(&slabs, (width, height), colours, chosen.border, Some(&surfaces));
        for step in steps {
            let step = step?;
            let phases = if step.is_dithered() { dither.phases(step.slab, spread.seed)? } else { Vec::new() };
            sweep.step(&step, &phases);
        }
        match &mut sum {
            None => sum = Some(sweep.seen),
            Some(sum) => {
                for (pixel, more) in sum.colour.iter_mut().zip(&sweep.seen.colour) {
                    pixel.iter_mut().zip(more).for_each(|(channel, more)| *channel += *more);
                }
            }
        }
    }
    let seen = sum.unwrap_or(Seen { colour: Vec::new(), opacity: Vec::new() });
    let narrow = |number: &T| number.wide() as f32;
    let light = seen.colour.iter().map(|pixel| [narrow(&pixel[0]), narrow(&pixel[1]), narrow(&pixel[2])]).collect();
    Ok((light, seen.opacity.iter().map(narrow).collect()))
}
