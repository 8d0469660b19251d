//! Passes on a software adapter: every kind of resource, several entry points, and mistakes in bindings.

use encase::ShaderType;

use super::draw::{self, Canvas, DepthBuffer, DepthTest, Drawing, Triangles};
use super::pass::{Module, Resources, Work};
use super::{AdapterChoice, Gpu};
use crate::emit::wgsl_text;

/// A software adapter, or nothing where there is none.
fn gpu() -> Option<Gpu> {
    Gpu::open(&AdapterChoice::Software).ok()
}

fn module(gpu: &Gpu, text: &str) -> Module {
    let validated = wgsl_text("test", text).unwrap_or_else(|e| panic!("{e}"));
    Module::new(gpu, "test", validated).unwrap_or_else(|e| panic!("{e}"))
}

/// The uniform of the shaders here: WGSL aligns the vector to 16 bytes.
#[derive(ShaderType)]
struct Settings {
    scale: f32,
    colour: glam::Vec3,
    offset: f32,
}

const SETTINGS: Settings = Settings { scale: 2.0, colour: glam::Vec3::new(0.25, 0.5, 1.0), offset: 3.0 };

/// Two entry points over one set of bindings in two groups: the first counts and stores, the second goes as far as
/// the first says.
const COMPUTE: &str = "
    struct Settings { scale: f32, colour: vec3<f32>, offset: f32 }
    @group(0) @binding(0) var<uniform> settings: Settings;
    @group(0) @binding(3) var picture: texture_2d<f32>;
    @group(0) @binding(4) var nearest: sampler;
    @group(0) @binding(7) var painted: texture_storage_2d<rgba32float, write>;
    @group(2) @binding(1) var<storage, read_write> values: array<f32>;
    @group(2) @binding(0) var<storage, read_write> work: array<atomic<u32>, 3>;
    @group(2) @binding(5) var<storage> unused: array<f32>;
    override BIAS: f32 = 0.0;

    @compute @workgroup_size(4, 2)
    fn first(@builtin(global_invocation_id) id: vec3<u32>) {
        if (any(id.xy >= textureDimensions(picture))) {
            return;
        }
        let texel = textureLoad(picture, id.xy, 0).r;
        let around = textureGather(0, picture, nearest, (vec2<f32>(id.xy) + 0.5) / vec2<f32>(textureDimensions(picture)));
        textureStore(painted, id.xy, vec4<f32>(settings.colour, max(around.x, texel)));
        values[id.y * textureDimensions(picture).x + id.x] = texel * settings.scale + settings.offset + BIAS;
        atomicAdd(&work[0], 1u);
        atomicStore(&work[1], 1u);
        atomicStore(&work[2], 1u);
    }

    @compute @workgroup_size(1)
    fn second(@builtin(global_invocation_id) id: vec3<u32>) {
        values[id.x] = -values[id.x];
    }";

#[test]
fn entry_points_share_bindings_in_several_groups_and_one_says_how_far_the_next_goes() {
    let Some(gpu) = gpu() else { return };
    let module = module(&gpu, COMPUTE);
    let settings = gpu.uniform("settings", &SETTINGS).unwrap_or_else(|e| panic!("{e}"));
    let texels: Vec<f32> = (0..15).map(|texel| texel as f32).collect();
    let picture = gpu.texture("picture", [5, 3], wgpu::TextureFormat::R32Float, &texels);
    let nearest = gpu.nearest();
    let painted = gpu.stored("painted", [5, 3], wgpu::TextureFormat::Rgba32Float);
    let painted_view = super::data::view(&painted);
    // One more than there are texels: the dispatch of the second is not to reach it.
    let values = gpu.results("values", 4 * 16);
    let work = gpu.results("work", 12);
    let groups = gpu.indirect("groups", 12);
    let resources = Resources::new()
        .buffer("settings", &settings)
        .texture("picture", &picture)
        .sampler("nearest", &nearest)
        .texture("painted", &painted_view)
        .buffer("values", &values)
        .buffer("work", &work)
        .buffer("unused", &values)
        .optional_buffer("elsewhere", Some(&values));
    let bound = module.bind(&gpu, &resources).unwrap_or_else(|e| panic!("{e}"));
    let first = module.compute(&gpu, "first", &[("BIAS", 0.5)]).unwrap_or_else(|e| panic!("{e}"));
    let second = module.compute(&gpu, "second", &[]).unwrap_or_else(|e| panic!("{e}"));
    assert!(matches!(first.covering([5, 3, 1]), Work::Groups([2, 2, 1])));
    gpu.submit(|encoder| {
        first.encode(encoder, &bound, first.covering([5, 3, 1]), 1, None);
        encoder.copy_buffer_to_buffer(&work, 0, &groups, 0, 12);
        second.encode(encoder, &bound, Work::Indirect(&groups), 1, None);
    });
    let read = gpu.read_buffer(&values, 4 * 16, bytemuck::pod_collect_to_vec::<u8, f32>);
    let mut expected: Vec<f32> = texels.iter().map(|texel| -(2.0 * texel + 3.5)).collect();
    expected.push(0.0);
    assert_eq!(read.unwrap_or_else(|e| panic!("{e}")), expected);
    let painted = gpu.read_texture::<[f32; 4]>(&painted).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(painted.len(), 15);
    assert_eq!(painted[6][..3], [0.25, 0.5, 1.0]);
}

#[test]
fn what_is_not_bound_or_not_declared_is_named() {
    let Some(gpu) = gpu() else { return };
    let module = module(&gpu, COMPUTE);
    let [values, work] = ["values", "work"].map(|name| gpu.results(name, 64));
    let message = |resources: &Resources<'_>| {
        let error = module.bind(&gpu, resources).expect_err("wrong");
        (error.diagnostics[0].message.clone(), error.to_string())
    };
    let some = Resources::new().buffer("values", &values).buffer("work", &work).buffer("vaules", &values);
    let (found, help) = message(&some);
    let missing = "uses `settings`, `picture`, `nearest`, `painted`, which nothing was bound to";
    assert_eq!(found, format!("the shader `test` {missing}, and does not declare `vaules`"));
    let declared = "`settings`, `picture`, `nearest`, `painted`, `values`, `work`, `unused`";
    assert!(help.contains(&format!("it declares: {declared}")), "{help}");
    let error = module.compute(&gpu, "third", &[]).expect_err("there is none");
    assert!(error.to_string().contains("it has no entry point `third` of this stage"), "{error}");
}

#[test]
fn a_kind_of_resource_that_does_not_fit_is_refused() {
    let Some(gpu) = gpu() else { return };
    let module = module(
        &gpu,
        "@group(0) @binding(0) var<storage, read_write> out: array<f32>;
         @compute @workgroup_size(1) fn only() { out[0] = 1.0; }",
    );
    let sampler = gpu.nearest();
    assert!(module.bind(&gpu, &Resources::new().sampler("out", &sampler)).is_err());
    assert_eq!(module.only_compute().unwrap_or_else(|e| panic!("{e}")), "only");
}

/// A triangle over the left half of a picture, and one over all of it, which the first hides.
#[test]
fn corners_are_laid_out_as_the_vertex_shader_says() {
    let Some(gpu) = gpu() else { return };
    let module = module(
        &gpu,
        "struct Settings { scale: f32, colour: vec3<f32>, offset: f32 }
         @group(0) @binding(0) var<uniform> settings: Settings;
         struct Corner { @location(3) place: vec2<f32>, @location(0) depth: f32 }
         @vertex fn place(corner: Corner) -> @builtin(position) vec4<f32> {
             return vec4<f32>(corner.place, corner.depth, 1.0);
         }
         @vertex fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
             return vec4<f32>(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.5, 1.0);
         }
         @fragment fn near() -> @location(0) vec4<f32> { return vec4<f32>(settings.colour, settings.offset); }
         @fragment fn far() -> @location(0) vec4<f32> { return vec4<f32>(settings.scale); }",
    );
    let settings = gpu.uniform("settings", &SETTINGS).unwrap_or_else(|e| panic!("{e}"));
    let bound = module.bind(&gpu, &Resources::new().buffer("settings", &settings)).unwrap_or_else(|e| panic!("{e}"));
    let test =
        DepthTest { format: wgpu::TextureFormat::Depth32Float, passes: wgpu::CompareFunction::Less, write: true };
    let draw = |vertex, fragment| {
        let targets = &[wgpu::TextureFormat::Rgba32Float];
        let drawing = Drawing { vertex, fragment, targets, depth: Some(test), constants: &[] };
        module.draw(&gpu, &drawing).unwrap_or_else(|e| panic!("{e}"))
    };
    let (near, far) = (draw("place", "near"), draw("cover", "far"));
    // Two triangles: x, y and depth of each corner.
    let quad = [[-1.0, -1.0], [0.0, -1.0], [0.0, 1.0], [-1.0, -1.0], [0.0, 1.0], [-1.0, 1.0]];
    let numbers: Vec<f32> = quad.iter().flat_map(|[x, y]| [*x, *y, 0.25]).collect();
    let corners = gpu.corners("corners", &numbers);
    let target = gpu.target("target", [4, 2], wgpu::TextureFormat::Rgba32Float);
    let depth = gpu.target("depth", [4, 2], wgpu::TextureFormat::Depth32Float);
    let views = [super::data::view(&target)];
    let depth_view = super::data::view(&depth);
    let buffer = DepthBuffer { view: &depth_view, clear: 1.0, keep: true };
    let canvas = Canvas { targets: &views, depth: Some(buffer) };
    let draws = [(&near, Triangles::Corners(&corners, 6)), (&far, Triangles::Cover)];
    gpu.submit(|encoder| draw::encode(encoder, &canvas, &bound, &draws, None));
    let read = gpu.read_texture::<[f32; 4]>(&target).unwrap_or_else(|e| panic!("{e}"));
    let row = [[0.25, 0.5, 1.0, 3.0], [0.25, 0.5, 1.0, 3.0], [2.0; 4], [2.0; 4]];
    assert_eq!(read, [row, row].concat());
    assert_eq!(gpu.read_texture::<f32>(&depth).unwrap_or_else(|e| panic!("{e}"))[..4], [0.25, 0.25, 0.5, 0.5]);
}
