//! RON text → [`Scene`].
//!
//! As in tables, independent parts are read one by one, so that a mistake in one
//! does not hide the mistakes in the others, and every number is checked where it
//! stands.

mod detail;
mod lights;
#[cfg(test)]
mod tests;

use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec3, EulerRot};
use serde::Deserialize;

use crate::diag::{Diagnostic, Source, codes};
use crate::scene::matter::{Gloss, Matter, Shine};
use crate::scene::shapes::Shape;
use crate::scene::shapes::letters;
use crate::scene::shapes::solid::{Solid, Triangle};
use crate::scene::view::Camera;
use crate::scene::{Object, Scene, mesh};
use crate::text::raw::{Raw, Reader};

type Result<T> = std::result::Result<T, Diagnostic>;

#[derive(Deserialize)]
#[serde(rename = "Scene", deny_unknown_fields)]
struct SceneRon<'a> {
    #[serde(default)]
    title: String,
    #[serde(borrow)]
    camera: Raw<'a>,
    #[serde(default)]
    light: Option<Raw<'a>>,
    #[serde(default)]
    lights: Option<Raw<'a>>,
    #[serde(default)]
    ambient: Option<Raw<'a>>,
    #[serde(default)]
    background: Option<Raw<'a>>,
    objects: Vec<Raw<'a>>,
}

#[derive(Deserialize)]
#[serde(rename = "Camera", deny_unknown_fields)]
struct CameraRon<'a> {
    #[serde(borrow)]
    eye: Raw<'a>,
    target: Raw<'a>,
    #[serde(default)]
    angle: Option<Raw<'a>>,
}

#[derive(Deserialize)]
#[serde(rename = "Object", deny_unknown_fields)]
struct ObjectRon<'a> {
    #[serde(borrow)]
    shape: Raw<'a>,
    #[serde(default)]
    at: Option<Raw<'a>>,
    #[serde(default)]
    turn: Option<Raw<'a>>,
    #[serde(default)]
    scale: Option<Raw<'a>>,
    #[serde(default)]
    colour: Option<Raw<'a>>,
    #[serde(default)]
    gloss: Option<Raw<'a>>,
    #[serde(default)]
    matter: Option<Raw<'a>>,
    #[serde(default)]
    shine: Option<Raw<'a>>,
    #[serde(default)]
    detail: Option<Raw<'a>>,
    #[serde(default)]
    transfer: Option<Raw<'a>>,
    #[serde(default)]
    copies: Option<Raw<'a>>,
}

#[derive(Deserialize)]
#[serde(rename = "Gloss", deny_unknown_fields)]
struct GlossRon<'a> {
    #[serde(borrow)]
    roughness: Raw<'a>,
    #[serde(default)]
    reflectance: Option<Raw<'a>>,
}

#[derive(Deserialize)]
#[serde(rename = "Matter", deny_unknown_fields)]
struct MatterRon<'a> {
    #[serde(borrow)]
    opacity: Raw<'a>,
    #[serde(default)]
    length: Option<Raw<'a>>,
    #[serde(default)]
    transport: Option<Raw<'a>>,
}

#[derive(Deserialize)]
#[serde(rename = "Shine", deny_unknown_fields)]
struct ShineRon<'a> {
    #[serde(borrow)]
    exponent: Raw<'a>,
    #[serde(default)]
    reflectance: Option<Raw<'a>>,
}

#[derive(Deserialize)]
#[serde(rename = "Copies", deny_unknown_fields)]
struct CopiesRon<'a> {
    #[serde(borrow)]
    count: Raw<'a>,
    step: Raw<'a>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
enum ShapeRon<'a> {
    Ground {
        #[serde(borrow)]
        size: Raw<'a>,
    },
    Block {
        size: Raw<'a>,
    },
    Ball {
        radius: Raw<'a>,
    },
    Column {
        radius: Raw<'a>,
        height: Raw<'a>,
    },
    Cylinder {
        radius: Raw<'a>,
        height: Raw<'a>,
    },
    Cone {
        radius: Raw<'a>,
        height: Raw<'a>,
    },
    Fence {
        bars: Raw<'a>,
        width: Raw<'a>,
        gap: Raw<'a>,
        height: Raw<'a>,
    },
    Lattice {
        cells: (Raw<'a>, Raw<'a>),
        size: Raw<'a>,
        width: Raw<'a>,
    },
    Foliage {
        leaves: Raw<'a>,
        radius: Raw<'a>,
        length: Raw<'a>,
        #[serde(default)]
        seed: u64,
    },
    Text {
        text: Raw<'a>,
        height: Raw<'a>,
        stroke: Raw<'a>,
    },
    Polygon {
        corners: Raw<'a>,
    },
    Teapot {
        #[serde(default)]
        divisions: Option<Raw<'a>>,
    },
    Mesh {
        file: Raw<'a>,
        #[serde(default)]
        size: Option<Raw<'a>>,
    },
}

/// Largest coordinate: far beyond it the shadow map would resolve nothing anyway.
const FAR: f64 = 1e6;
/// Smallest extent.
const SMALL: f64 = 1e-6;
/// Most corners of a polygon.
const MAX_CORNERS: usize = 64;
/// Most triangles of a scene.
const MAX_TRIANGLES: usize = 20_000_000;

/// Reads a scene.
pub(super) fn scene(name: &str, source: &Arc<Source>, directory: &Path) -> std::result::Result<Scene, Vec<Diagnostic>> {
    let reader = Reader::new(source);
    let ron: SceneRon<'_> = reader.get(reader.whole()).map_err(|error| vec![error])?;
    let read = Read { reader, directory };
    let mut problems = Vec::new();
    let camera = read.camera(ron.camera).map_err(|error| problems.push(error)).ok();
    let lights = read.lights(ron.light, ron.lights).map_err(|errors| problems.extend(errors)).ok();
    let mut keep = |error: Diagnostic| problems.push(error);
    let ambient = read.or(ron.ambient, 0.25, |raw| read.number(raw, 0.0, 1.0)).map_err(&mut keep).ok();
    let background = read.or(ron.background, [0.55, 0.65, 0.8], |raw| read.colour(raw)).map_err(&mut keep).ok();
    let mut objects = Vec::new();
    for raw in &ron.objects {
        match read.object(*raw) {
            Ok(object) => objects.push(object),
            Err(error) => keep(error),
        }
        if objects.iter().map(|object: &Object| object.triangles.len()).sum::<usize>() > MAX_TRIANGLES {
            keep(read.wrong(*raw, &format!("with this the scene has more than {MAX_TRIANGLES} triangles")));
            break;
        }
    }
    if ron.objects.is_empty() {
        keep(Diagnostic::error(codes::SCENE, "the scene is empty").help("list at least one object"));
    }
    match (camera, lights, ambient, background) {
        (Some(camera), Some(lights), Some(ambient), Some(background)) if problems.is_empty() => {
            Ok(Scene { name: name.to_owned(), title: ron.title, camera, lights, ambient, background, objects })
        }
        _ => Err(problems),
    }
}

struct Read<'a> {
    reader: Reader<'a>,
    directory: &'a Path,
}

impl<'a> Read<'a> {
    fn wrong(&self, raw: Raw<'a>, message: &str) -> Diagnostic {
        Diagnostic::error(codes::SCENE, message).at(self.reader.span(raw), "here")
    }

    fn or<T>(&self, raw: Option<Raw<'a>>, default: T, read: impl Fn(Raw<'a>) -> Result<T>) -> Result<T> {
        raw.map_or(Ok(default), read)
    }

    fn check(&self, raw: Raw<'a>, numbers: &[f64], lo: f64, hi: f64) -> Result<()> {
        match numbers.iter().find(|number| !(lo..=hi).contains(*number)) {
            None => Ok(()),
            Some(number) => {
                Err(self.wrong(raw, &format!("{number} is out of range")).help(format!("expected {lo} to {hi}")))
            }
        }
    }

    fn number(&self, raw: Raw<'a>, lo: f64, hi: f64) -> Result<f64> {
        let number: f64 = self.reader.get(raw)?;
        self.check(raw, &[number], lo, hi)?;
        Ok(number)
    }

    fn length(&self, raw: Raw<'a>) -> Result<f64> {
        self.number(raw, SMALL, FAR)
    }

    fn count(&self, raw: Raw<'a>, most: u32) -> Result<u32> {
        let count: u32 = self.reader.get(raw)?;
        if (1..=most).contains(&count) {
            return Ok(count);
        }
        Err(self.wrong(raw, &format!("{count} is out of range")).help(format!("expected 1 to {most}")))
    }

    fn pair(&self, raw: Raw<'a>) -> Result<[f64; 2]> {
        let (x, y): (f64, f64) = self.reader.get(raw)?;
        self.check(raw, &[x, y], SMALL, FAR)?;
        Ok([x, y])
    }

    fn triple(&self, raw: Raw<'a>, lo: f64, hi: f64) -> Result<[f64; 3]> {
        let (x, y, z): (f64, f64, f64) = self.reader.get(raw)?;
        self.check(raw, &[x, y, z], lo, hi)?;
        Ok([x, y, z])
    }

    fn place(&self, raw: Raw<'a>) -> Result<DVec3> {
        Ok(DVec3::from_array(self.triple(raw, -FAR, FAR)?))
    }

    fn colour(&self, raw: Raw<'a>) -> Result<[f64; 3]> {
        self.triple(raw, 0.0, 1.0)
    }

    fn angle(&self, raw: Raw<'a>) -> Result<f64> {
        self.number(raw, 0.1, 170.0)
    }

    fn camera(&self, raw: Raw<'a>) -> Result<Camera> {
        let ron: CameraRon<'_> = self.reader.get(raw)?;
        let camera = Camera {
            eye: self.place(ron.eye)?,
            target: self.place(ron.target)?,
            angle: self.or(ron.angle, 40.0, |raw| self.angle(raw))?,
        };
        if (camera.target - camera.eye).length() < SMALL {
            return Err(self.wrong(raw, "the camera looks at its own place").help("move `eye` or `target`"));
        }
        Ok(camera)
    }

    fn matter(&self, raw: Raw<'a>) -> Result<Matter> {
        let ron: MatterRon<'_> = self.reader.get(raw)?;
        Ok(Matter {
            opacity: self.number(ron.opacity, 0.0, 1.0)?,
            length: self.or(ron.length, Matter::OPAQUE.length, |raw| self.length(raw))?,
            transport: self.or(ron.transport, Matter::OPAQUE.transport, |raw| self.colour(raw))?,
        })
    }

    fn shine(&self, raw: Raw<'a>) -> Result<Shine> {
        let ron: ShineRon<'_> = self.reader.get(raw)?;
        Ok(Shine {
            exponent: self.number(ron.exponent, 1.0, 1000.0)?,
            reflectance: self.or(ron.reflectance, 0.04, |raw| self.number(raw, 0.0, 1.0))?,
        })
    }

    fn gloss(&self, raw: Raw<'a>) -> Result<Gloss> {
        let ron: GlossRon<'_> = self.reader.get(raw)?;
        Ok(Gloss {
            roughness: self.number(ron.roughness, 0.0, 1.0)?,
            // Glass, varnish, most plastics.
            reflectance: self.or(ron.reflectance, 0.04, |raw| self.number(raw, 0.0, 1.0))?,
        })
    }

    fn object(&self, raw: Raw<'a>) -> Result<Object> {
        let ron: ObjectRon<'_> = self.reader.get(raw)?;
        let at = self.or(ron.at, DVec3::ZERO, |raw| self.place(raw))?;
        let [x, y, z] = self.or(ron.turn, [0.0; 3], |raw| self.triple(raw, -360.0, 360.0))?.map(f64::to_radians);
        let scale = self.or(ron.scale, 1.0, |raw| self.length(raw))?;
        let colour = self.or(ron.colour, [0.75, 0.75, 0.75], |raw| self.colour(raw))?;
        let gloss = ron.gloss.map(|raw| self.gloss(raw)).transpose()?;
        let matter = self.or(ron.matter, Matter::OPAQUE, |raw| self.matter(raw))?;
        let shine = ron.shine.map(|raw| self.shine(raw)).transpose()?;
        let (count, step) = match ron.copies {
            None => (1, DVec3::ZERO),
            Some(raw) => {
                let ron: CopiesRon<'_> = self.reader.get(raw)?;
                (self.count(ron.count, 1000)?, self.place(ron.step)?)
            }
        };
        let (shape, casts) = self.shape(ron.shape)?;
        if shape.triangles.len() * count as usize > MAX_TRIANGLES {
            return Err(self.wrong(raw, &format!("the object has more than {MAX_TRIANGLES} triangles")));
        }
        let turn = DQuat::from_euler(EulerRot::YXZ, y, x, z);
        let place = |index: u32| {
            DAffine3::from_scale_rotation_translation(DVec3::splat(scale), turn, at + step * f64::from(index))
        };
        let detail = self.detail(raw, (ron.detail, ron.transfer), (colour, matter), place(0).inverse())?;
        let mut solid = Solid::default();
        for index in 0..count {
            solid.add(&shape, &place(index), scale);
        }
        Ok(Object { colour, gloss, matter, shine, detail, casts, triangles: solid.triangles, parts: solid.parts })
    }

    /// The surface of a shape, and whether the shadow map is fitted to it.
    fn shape(&self, raw: Raw<'a>) -> Result<(Solid, bool)> {
        let shape = match self.reader.get(raw)? {
            ShapeRon::Ground { size } => Shape::Ground { size: self.pair(size)? },
            ShapeRon::Block { size } => Shape::Block { size: self.triple(size, SMALL, FAR)? },
            ShapeRon::Ball { radius } => Shape::Ball { radius: self.length(radius)? },
            ShapeRon::Column { radius, height } => {
                Shape::Column { radius: self.length(radius)?, height: self.length(height)? }
            }
            ShapeRon::Cylinder { radius, height } => {
                Shape::Cylinder { radius: self.length(radius)?, height: self.length(height)? }
            }
            ShapeRon::Cone { radius, height } => {
                Shape::Cone { radius: self.length(radius)?, height: self.length(height)? }
            }
            ShapeRon::Fence { bars, width, gap, height } => Shape::Fence {
                bars: self.count(bars, 10_000)?,
                width: self.length(width)?,
                gap: self.length(gap)?,
                height: self.length(height)?,
            },
            ShapeRon::Lattice { cells: (across, up), size, width } => Shape::Lattice {
                cells: [self.count(across, 1000)?, self.count(up, 1000)?],
                size: self.pair(size)?,
                width: self.length(width)?,
            },
            ShapeRon::Foliage { leaves, radius, length, seed } => Shape::Foliage {
                leaves: self.count(leaves, 1_000_000)?,
                radius: self.length(radius)?,
                length: self.length(length)?,
                seed,
            },
            ShapeRon::Text { text: at, height, stroke } => {
                let text: String = self.reader.get(at)?;
                if let Some(letter) = letters::unknown(&text) {
                    let error = self.wrong(at, &format!("`{letter}` cannot be written"));
                    return Err(error.help(format!("known are {}", letters::KNOWN)));
                }
                if text.trim().is_empty() || text.len() > 200 {
                    return Err(self.wrong(at, "the text is empty or too long").help("write 1 to 200 letters"));
                }
                Shape::Text { text, height: self.length(height)?, stroke: self.length(stroke)? }
            }
            ShapeRon::Polygon { corners } => Shape::Polygon { corners: self.polygon(corners, MAX_CORNERS)? },
            ShapeRon::Teapot { divisions } => {
                Shape::Teapot { divisions: self.or(divisions, 24, |raw| self.count(raw, 256))? }
            }
            ShapeRon::Mesh { file, size } => {
                let size = size.map(|raw| self.length(raw)).transpose()?;
                return Ok((Solid { triangles: self.mesh(file, size)?, parts: Vec::new() }, true));
            }
        };
        Ok((shape.solid(), shape.casts()))
    }

    /// A mesh as it is, or standing around the origin with its largest extent scaled to a size.
    fn mesh(&self, file: Raw<'a>, size: Option<f64>) -> Result<Vec<Triangle>> {
        let name: String = self.reader.get(file)?;
        let triangles =
            mesh::read(self.directory, &name).map_err(|error| error.at(self.reader.span(file), "named here"))?;
        let Some(size) = size else { return Ok(triangles) };
        let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let corners = triangles.iter().flat_map(|triangle| triangle.corners);
        let (lo, hi) = corners.fold(start, |(lo, hi), at| (lo.min(at), hi.max(at)));
        let scale = size / (hi - lo).max_element();
        let foot = DVec3::new((lo.x + hi.x) / 2.0, lo.y, (lo.z + hi.z) / 2.0);
        let place = DAffine3::from_scale(DVec3::splat(scale)) * DAffine3::from_translation(-foot);
        Ok(triangles.iter().map(|triangle| triangle.moved(&place)).collect())
    }
}
