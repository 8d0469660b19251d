//! Scenes: what is lit, by what, seen from where.
//!
//! A scene is a RON file; some come with Umbrage and are known by name. After
//! reading there are triangles, lights and one camera, and nothing that a
//! renderer would have to check again.

pub(crate) mod flat;
pub mod light;
pub mod matter;
mod mesh;
pub mod rays;
mod read;
pub(crate) mod round;
mod shapes;
pub mod surfaces;
pub mod view;

use std::path::Path;

use crate::diag::{Diagnostic, Failure, Source, codes};
use crate::scene::light::{Light, Lights, Punctual};
use crate::scene::matter::{Detail, Gloss, Matter, Shine};
use crate::scene::view::Camera;
use crate::text::closest::nearest;
use crate::text::file;

pub use shapes::Shape;
pub use shapes::solid::{Form, Part, Triangle};

/// Largest accepted scene file, in bytes.
const MAX_BYTES: u64 = 16 << 20;

/// A scene, ready to be rendered.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Its name: that of a built-in scene, or the stem of its file's name.
    pub name: String,
    /// Its title.
    pub title: String,
    /// Its viewpoint.
    pub camera: Camera,
    /// Its lights; at least one.
    pub lights: Vec<Light>,
    /// The share of light that reaches shadows.
    pub ambient: f64,
    /// Colour of the background, linear.
    pub background: [f64; 3],
    /// Its contents; at least one object, each with at least one triangle.
    pub objects: Vec<Object>,
}

/// A thing in a scene.
#[derive(Debug, Clone)]
pub struct Object {
    /// Its colour, linear.
    pub colour: [f64; 3],
    /// The rough mirror on top of it, for techniques that show it.
    pub gloss: Option<Gloss>,
    /// The matter inside of its surface, for techniques that look there.
    pub matter: Matter,
    /// Facets of its surface, for techniques that reflect light.
    pub shine: Option<Shine>,
    /// A pattern inside of it, for techniques that look there.
    pub detail: Option<Detail>,
    /// True of objects that the shadow map is fitted to.
    pub casts: bool,
    /// Its surface, seen from both sides.
    pub triangles: Vec<Triangle>,
    /// The exact forms of its surface, with the triangles that stand for each; in the order of the triangles.
    pub parts: Vec<Part>,
}

impl Object {
    /// Returns whether all of its surface has an exact form.
    pub fn is_exact(&self) -> bool {
        self.parts.iter().map(|part| part.triangles.len()).sum::<usize>() == self.triangles.len()
    }
}

/// The scenes that come with Umbrage, by name.
const BUILT_IN: [(&str, &str); 24] = [
    ("abutting", include_str!("../../scenes/abutting.ron")),
    ("boxes", include_str!("../../scenes/boxes.ron")),
    ("clouds", include_str!("../../scenes/clouds.ron")),
    ("coincident", include_str!("../../scenes/coincident.ron")),
    ("columns", include_str!("../../scenes/columns.ron")),
    ("dining", include_str!("../../scenes/dining.ron")),
    ("disk", include_str!("../../scenes/disk.ron")),
    ("fence", include_str!("../../scenes/fence.ron")),
    ("foliage", include_str!("../../scenes/foliage.ron")),
    ("grazing", include_str!("../../scenes/grazing.ron")),
    ("hexagon", include_str!("../../scenes/hexagon.ron")),
    ("lattice", include_str!("../../scenes/lattice.ron")),
    ("leaves", include_str!("../../scenes/leaves.ron")),
    ("opening", include_str!("../../scenes/opening.ron")),
    ("outdoor", include_str!("../../scenes/outdoor.ron")),
    ("poles", include_str!("../../scenes/poles.ron")),
    ("skittles", include_str!("../../scenes/skittles.ron")),
    ("slope", include_str!("../../scenes/slope.ron")),
    ("studio", include_str!("../../scenes/studio.ron")),
    ("table", include_str!("../../scenes/table.ron")),
    ("teapot", include_str!("../../scenes/teapot.ron")),
    ("text", include_str!("../../scenes/text.ron")),
    ("tilt", include_str!("../../scenes/tilt.ron")),
    ("trio", include_str!("../../scenes/trio.ron")),
];

impl Scene {
    /// The names of the scenes that come with Umbrage, sorted.
    pub fn names() -> impl Iterator<Item = &'static str> {
        BUILT_IN.iter().map(|(name, _)| *name)
    }

    /// The scene with a name, or in a file.
    ///
    /// # Errors
    /// When there is no such scene, or when it is wrong.
    ///
    /// ```
    /// use umbrage::scene::Scene;
    ///
    /// let scene = Scene::open("fence")?;
    /// assert!(scene.triangles().count() > 100);
    /// assert!(Scene::open("fense").unwrap_err().to_string().contains("did you mean `fence`?"));
    /// # Ok::<(), umbrage::diag::Failure>(())
    /// ```
    pub fn open(name: &str) -> Result<Self, Failure> {
        if let Some((name, text)) = BUILT_IN.iter().find(|(known, _)| *known == name) {
            return Self::parse(name, &Source::new(format!("scenes/{name}.ron"), *text), Path::new("scenes"));
        }
        let path = Path::new(name);
        if path.extension().is_none() && !path.exists() {
            let error = Diagnostic::error(codes::SCENE, format!("there is no scene `{name}`"));
            let known: Vec<&str> = Self::names().collect();
            let error = match nearest(name, known.iter().copied()) {
                Some(close) => error.did_you_mean(name, close),
                None => error,
            };
            let known = format!("the scenes are: {}; or give the path of a scene file (*.ron)", known.join(", "));
            return Err(Failure::bare("", error.help(known)));
        }
        let shown = file::shown(path);
        let source = Source::new(shown, file::read_text(path, MAX_BYTES)?);
        let stem = path.file_stem().map_or_else(|| "scene".to_owned(), |stem| stem.to_string_lossy().into_owned());
        Self::parse(&stem, &source, path.parent().unwrap_or(Path::new("")))
    }

    /// Reads a scene from its text. Meshes are looked for below `directory`.
    ///
    /// # Errors
    /// With every mistake found, each at its place.
    pub fn parse(name: &str, source: &std::sync::Arc<Source>, directory: &Path) -> Result<Self, Failure> {
        read::scene(name, source, directory).map_err(|diagnostics| Failure { source: source.clone(), diagnostics })
    }

    /// All triangles, with the number of the object that each belongs to.
    pub fn triangles(&self) -> impl Iterator<Item = (usize, &Triangle)> {
        self.objects.iter().enumerate().flat_map(|(index, object)| object.triangles.iter().map(move |t| (index, t)))
    }

    /// Returns whether it has a light without extent.
    pub fn has_punctual(&self) -> bool {
        self.lights.iter().any(|light| light.punctual().is_some())
    }

    /// The first light without extent: the one that techniques on a shadow map take.
    ///
    /// # Errors
    /// When there is none.
    pub fn punctual(&self, technique: &str) -> Result<Punctual, Failure> {
        let lights = Lights::PUNCTUAL.of_scene(self, technique)?;
        let missing = || Failure::bare("", Diagnostic::error(codes::SCENE, "the scene has no light without extent"));
        lights.into_iter().find_map(Light::punctual).ok_or_else(missing)
    }
}
