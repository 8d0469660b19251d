//! The passes before a technique, by rasterising: what the light sees, and where
//! what the camera sees lies in it.
//!
//! They make the same [`ShadowMap`] and [`Receivers`] as the rays of
//! [`passes`](crate::technique::revectorise::stage), but for pixels at the borders of faces.

use encase::ShaderType;
use glam::DVec3;

use super::frame::{check_map, check_picture};
use crate::diag::{Diagnostic, Failure, codes};
use crate::emit::wgsl_text;
use crate::gpu::draw::{self, Canvas, DepthBuffer, DepthTest, Drawing, Triangles};
use crate::gpu::pass::{Module, Resources};
use crate::gpu::{CompareFunction, Gpu, Texture, TextureFormat, view};
use crate::scene::light::Punctual;
use crate::scene::view::View;
use crate::technique::revectorise::stage::{Bias, Stage};
use crate::technique::revectorise::{DEPTH_UNIT, Receiver, ReceiverKind, Receivers, ShadowMap, max_slope};

const SHADER: &str = include_str!("wgsl/raster.wgsl");

/// Numbers of a corner of a face: clip coordinates of light and camera, anchor, slope.
const WORDS: usize = 14;
const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// The uniform `goal` of raster.wgsl.
#[derive(ShaderType)]
struct Target {
    size: f32,
    max_slope: f32,
    unit: f32,
    constant: f32,
    slope: f32,
}

/// The view of a camera.
#[derive(Debug, Clone)]
pub struct GpuPicture {
    /// The places of its pixels in the shadow map.
    pub receivers: Receivers,
    /// For each pixel the number of the triangle that is seen, in the scene's order; `None` for the background.
    pub triangles: Vec<Option<u32>>,
}

/// A scene on a device.
#[derive(Debug)]
pub struct Raster<'g, 's> {
    gpu: &'g Gpu,
    stage: &'s Stage<'s>,
    module: Module,
}

impl<'g, 's> Raster<'g, 's> {
    /// Prepares a scene.
    ///
    /// # Errors
    /// When the device fails.
    pub fn new(gpu: &'g Gpu, stage: &'s Stage<'s>) -> Result<Self, Failure> {
        let module = Module::new(gpu, "raster", wgsl_text("raster", SHADER)?)?;
        Ok(Self { gpu, stage, module })
    }

    /// Renders the view of the light.
    ///
    /// # Errors
    /// When the size is beyond the device's limits, or the device fails.
    pub fn shadow_map(&self, size: u32, bias: Bias) -> Result<ShadowMap, Failure> {
        check_map(self.gpu, size)?;
        let depth = self.gpu.target("depths", [size; 2], DEPTH);
        self.draw(["from_light", "shadow_map"], size, bias, &[], &depth)?;
        let depth = self.gpu.read_texture(&depth)?;
        Ok(ShadowMap { size, depth })
    }

    /// Renders the view of the camera, with its places in a shadow map of a size.
    ///
    /// # Errors
    /// When the sizes are beyond the device's limits, or the device fails.
    pub fn picture(&self, width: u32, height: u32, size: u32) -> Result<GpuPicture, Failure> {
        check_map(self.gpu, size)?;
        check_picture(self.gpu, width, height)?;
        let pixels = [width, height];
        let depth = self.gpu.target("depths", pixels, DEPTH);
        let targets = [TextureFormat::Rgba32Float, TextureFormat::Rg32Float, TextureFormat::R32Uint]
            .map(|format| self.gpu.target("receivers", pixels, format));
        self.draw(["from_camera", "receivers"], size, Bias::default(), &targets, &depth)?;
        let [points, slopes, faces] = targets;
        let points = self.gpu.read_texture::<[f32; 4]>(&points)?;
        let slopes = self.gpu.read_texture::<[f32; 2]>(&slopes)?;
        let faces = self.gpu.read_texture::<u32>(&faces)?;
        let receivers = points.into_iter().zip(slopes).zip(&faces).map(|(([u, v, z, kind], [dz_dx, dz_dy]), face)| {
            let kind = match (face, kind) {
                (0, _) => return Receiver::default(),
                (_, 1.0) => ReceiverKind::Facing,
                _ => ReceiverKind::Away,
            };
            Receiver { u, v, z, kind, dz_dx, dz_dy }
        });
        let receivers = Receivers { width, height, points: receivers.collect() };
        Ok(GpuPicture { receivers, triangles: faces.iter().map(|face| face.checked_sub(1)).collect() })
    }

    /// The corners of all faces, for a picture.
    fn vertices(&self, camera: &View) -> Vec<f32> {
        let triangles = self.stage.rays.triangles();
        let mut words = Vec::with_capacity(3 * WORDS * triangles.len());
        for triangle in triangles {
            let corners = triangle.corners;
            let (anchor, slope) = self.plane(corners);
            for corner in corners {
                let clips = [&self.stage.light_view, camera].map(|view| (view.matrix * corner.extend(1.0)).as_vec4());
                words.extend(clips.iter().flat_map(|clip| clip.to_array()));
                words.extend(anchor);
                words.extend(slope);
            }
        }
        words
    }

    /// The plane of a face over the light's square: a place with its depth and whether the side that
    /// the camera sees faces the light, and the slopes.
    fn plane(&self, corners: [DVec3; 3]) -> ([f32; 4], [f32; 2]) {
        let view = &self.stage.light_view;
        let Some(plane) = view.plane(corners) else { return ([0.0; 4], [0.0; 2]) };
        let places = corners.into_iter().filter_map(|corner| view.project(corner));
        let anchors = places.map(|(place, _)| {
            let place = place.clamp(glam::DVec2::ZERO, glam::DVec2::ONE);
            (place, plane.at(place.x, place.y))
        });
        // Single precision is finest where depths are small.
        let nearest = anchors.min_by(|a, b| (a.1 - 0.5).abs().total_cmp(&(b.1 - 0.5).abs()));
        let Some((place, depth)) = nearest else { return ([0.0; 4], [0.0; 2]) };
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let to_light = match self.stage.light {
            Punctual::Directional(light) => -light.direction,
            Punctual::Spot(light) => light.position - corners[0],
        };
        let to_eye = self.stage.scene.camera.eye - corners[0];
        let facing = normal.dot(to_light) * normal.dot(to_eye) > 0.0;
        let anchor = [place.x as f32, place.y as f32, depth as f32, f32::from(u8::from(facing))];
        (anchor, [plane.du as f32, plane.dv as f32])
    }

    /// Draws all faces with a vertex and a fragment shader.
    fn draw(
        &self,
        [vertex, fragment]: [&str; 2],
        size: u32,
        bias: Bias,
        targets: &[Texture],
        depth: &Texture,
    ) -> Result<(), Failure> {
        let gpu = self.gpu;
        let camera = self.stage.scene.camera.view(depth.width(), depth.height());
        let vertices = self.vertices(&camera);
        let most = gpu.largest_buffer();
        if size_of_val(vertices.as_slice()) as u64 > most {
            let triangles = vertices.len() / (3 * WORDS);
            let error = Diagnostic::error(codes::DEVICE, format!("a scene of {triangles} triangles does not fit"))
                .help(format!("buffers on {} have at most {most} bytes; try `--backend cpu`", gpu.describe()));
            return Err(Failure::bare("", error));
        }
        let corners = gpu.corners("corners", &vertices);
        let Bias { constant, slope } = bias;
        let goal = Target { size: size as f32, max_slope: max_slope(size), unit: DEPTH_UNIT, constant, slope };
        let goal = gpu.uniform("goal", &goal)?;
        let bound = self.module.bind(gpu, &Resources::new().buffer("goal", &goal))?;
        let formats: Vec<_> = targets.iter().map(Texture::format).collect();
        let test = DepthTest { format: DEPTH, passes: CompareFunction::Less, write: true };
        let drawing = Drawing { vertex, fragment, targets: &formats, depth: Some(test), constants: &[] };
        let faces = self.module.draw(gpu, &drawing)?;
        let targets: Vec<_> = targets.iter().map(view).collect();
        let depth = DepthBuffer { view: &view(depth), clear: 1.0, keep: true };
        let canvas = Canvas { targets: &targets, depth: Some(depth) };
        let triangles = Triangles::Corners(&corners, (vertices.len() / WORDS) as u32);
        gpu.submit(|encoder| draw::encode(encoder, &canvas, &bound, &[(&faces, triangles)], None));
        gpu.check()
    }
}
