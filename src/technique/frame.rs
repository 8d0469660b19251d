//! Frames: a scene at a size, with everything that techniques share.

use std::any::{Any, TypeId};
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use super::{Executor, Settings, Technique, tables::BuiltIn};
use crate::diag::Failure;
use crate::program::Program;
use crate::prove::Proved;
use crate::scene::Scene;
use crate::scene::rays::Rays;
use crate::scene::surfaces::Surfaces;

/// A scene at a size, how it is to be rendered, and on which machine.
///
/// Frames are cheap to clone, and clones share what was made for the first: the same scene with other settings is
/// a clone with other [`Frame::settings`].
#[derive(Clone)]
pub struct Frame<'s> {
    /// The scene.
    pub scene: &'s Scene,
    /// The machine.
    pub on: &'s Executor,
    /// The scene's triangles, for rays.
    pub rays: Arc<Rays>,
    /// The surfaces that the camera sees, at the size of the frame.
    pub surfaces: Arc<Surfaces>,
    /// The settings that were chosen.
    pub settings: Settings,
    /// A table to evaluate instead of a technique's own.
    pub table: Option<&'s Program>,
    /// Proved plans to use instead of a technique's own, each for the table that it is a plan of.
    pub plans: Vec<&'s Proved<'s>>,
    /// Casts rays even where a device would rasterise, so that results are the same on every machine.
    pub by_rays: bool,
    shared: Arc<Shared>,
}

/// Things that several techniques need, by type and key.
#[derive(Default)]
struct Shared(Mutex<Vec<(TypeId, String, Thing)>>);

/// A value that techniques share: made once, by whichever needs it first.
type Thing = Arc<dyn Any + Send + Sync>;

impl<'s> Frame<'s> {
    /// A frame of a scene: sees its surfaces.
    pub fn new(scene: &'s Scene, (width, height): (u32, u32), on: &'s Executor) -> Self {
        let rays = Arc::new(Rays::new(scene));
        let surfaces = Arc::new(Surfaces::new(scene, &rays, width, height));
        Self {
            scene,
            on,
            rays,
            surfaces,
            settings: Settings::default(),
            table: None,
            plans: Vec::new(),
            by_rays: false,
            shared: Arc::default(),
        }
    }

    /// The same frame with other settings.
    #[must_use]
    pub fn with(&self, settings: Settings) -> Self {
        Self { settings, ..self.clone() }
    }

    /// Pixels per row, and rows.
    pub fn size(&self) -> (u32, u32) {
        (self.surfaces.width, self.surfaces.height)
    }

    /// The size of the frame and the settings of techniques that change what is seen, in words.
    pub fn describe(&self, techniques: &[&dyn Technique]) -> String {
        let (width, height) = self.size();
        let mut words = vec![format!("{width}x{height}")];
        for setting in techniques.iter().flat_map(|technique| technique.settings()) {
            let word = format!("{} {}", setting.label, self.settings.value(setting));
            if !setting.label.is_empty() && !words.contains(&word) {
                words.push(word);
            }
        }
        words.join(", ")
    }

    /// The program that stands for a built-in table.
    ///
    /// # Errors
    /// When a built-in table cannot be read.
    pub fn program(&self, built_in: &'static BuiltIn) -> Result<&'s Program, Failure> {
        match self.table {
            Some(program) => Ok(program),
            None => built_in.program(),
        }
    }

    /// A value that techniques share: made at the first call with this key, and the same at every other call with it, of
    /// this frame and of its clones. The key has to say everything that the value depends on but scene, size and
    /// machine.
    ///
    /// # Errors
    /// When it cannot be made.
    pub fn shared<T: Any + Send + Sync>(
        &self,
        key: impl fmt::Debug,
        make: impl FnOnce() -> Result<T, Failure>,
    ) -> Result<Arc<T>, Failure> {
        let (kind, key) = (TypeId::of::<T>(), format!("{key:?}"));
        let found = {
            let entries = self.shared.0.lock().unwrap_or_else(PoisonError::into_inner);
            entries.iter().find(|(of, known, _)| *of == kind && *known == key).map(|(.., value)| Arc::clone(value))
        };
        if let Some(Ok(value)) = found.map(Arc::downcast) {
            return Ok(value);
        }
        let value = Arc::new(make()?);
        let mut entries = self.shared.0.lock().unwrap_or_else(PoisonError::into_inner);
        entries.push((kind, key, value.clone()));
        Ok(value)
    }
}

impl fmt::Debug for Frame<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Frame").field("scene", &self.scene.name).field("size", &self.size()).finish_non_exhaustive()
    }
}
