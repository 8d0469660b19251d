//! A picture: layers, slabs, lights and steps of a scene put together, and swept.

use std::sync::Arc;

use super::inside::Changes;
use super::layers::Layers;
use super::light::{SlopeLight, nodes};
use super::matter::{Material, SceneSlabs, Stack};
use super::settings::Chosen;
use super::stencil::Real;
use super::steps::{Spread, steps};
use super::sweep::{Seen, Sweep};
use super::view::SlabView;
use crate::diag::{Diagnostic, Failure, codes};
use crate::scene::Scene;
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
    depths: Option<(f64, f64)>,
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
            Ok(Self { view, changes, counts, depths: layers.depths() })
        })
    }

    /// The slabs that hold everything that is seen: the farthest surface lies before the end of the last one.
    pub fn stack(&self, count: usize) -> Option<Stack> {
        let (front, back) = self.depths?;
        let depth = (back - front).max(1e-6 * front.abs().max(1.0)) * (1.0 + 1e-9);
        Some(Stack { front, thickness: depth / count as f64, count })
    }
}

/// The materials of a scene's objects.
fn materials(scene: &Scene) -> Vec<Material> {
    scene.objects.iter().map(|object| Material { colour: object.colour, matter: object.matter }).collect()
}

/// Renders a frame.
///
/// # Errors
/// When a light or a kernel cannot be used.
pub fn picture(frame: &Frame<'_>, chosen: &Chosen) -> Result<Picture, Failure> {
    let crossed = Crossed::of(frame, chosen)?;
    let lights = SlopeLight::of_scene(frame.scene, &crossed.view)?;
    let nodes = nodes(chosen.split.lights)?;
    let lights: Vec<SlopeLight> = lights.iter().flat_map(|light| light.split(&nodes, chosen.split.rho)).collect();
    let (light, opacity) = match crossed.stack(chosen.slabs) {
        None => {
            let pixels = crossed.counts.len();
            (vec![[0.0; 3]; pixels], vec![0.0; pixels])
        }
        Some(stack) if chosen.wide => swept::<f64>(frame.scene, &crossed, stack, &lights, chosen)?,
        Some(stack) => swept::<f32>(frame.scene, &crossed, stack, &lights, chosen)?,
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
    stack: Stack,
    lights: &[SlopeLight],
    chosen: &Chosen,
) -> Result<Pixels, Failure> {
    let (width, height) = (crossed.view.size.0 as usize, crossed.view.size.1 as usize);
    let slabs = SceneSlabs::new(&crossed.changes, stack, width, chosen.policies, materials(scene))?;
    let half_depth = 0.5 * stack.thickness * stack.count as f64;
    let d1 = if chosen.spread.d1 > 0.0 { chosen.spread.d1 } else { half_depth };
    let spread = Spread { d1, ..chosen.spread };
    let occupied = slabs.occupied();
    let of_one = 2 * 3 * width * height * size_of::<T>();
    if of_one > 8 * MOST_LIGHT {
        let message = format!("the images of one light would take {} MiB", of_one >> 20);
        return Err(Failure::bare("", Diagnostic::error(codes::RENDER, message).help("make the picture smaller")));
    }
    let mut sum: Option<Seen<T>> = None;
    let none: &[SlopeLight] = &[];
    let portions: Vec<&[SlopeLight]> = match lights.len() {
        0 => vec![none],
        _ => lights.chunks((MOST_LIGHT / of_one).max(1)).collect(),
    };
    for portion in portions {
        let steps = steps::<T>(portion, stack, &occupied, &spread, &crossed.view)?;
        let colours = portion.iter().map(|light| light.colour).collect();
        let mut sweep = Sweep::<_, T>::new(&slabs, (width, height), colours, chosen.border);
        steps.iter().for_each(|step| sweep.step(step));
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
