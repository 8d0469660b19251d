//! Passes made from a shader's own interface.
//!
//! A [`Module`] derives the layouts of its groups and pipelines from the reflected
//! text, for all of its entry points together, so that one set of bindings serves
//! them all. The host names resources as the shader does:
//!
//! ```text
//! let module = Module::new(gpu, "blur", wgsl_text("blur", TEXT)?)?;
//! let resources = Resources::new().buffer("settings", &settings).texture("picture", &view).buffer("out", &out);
//! let bound = module.bind(gpu, &resources)?;
//! let rows = module.compute(gpu, "rows", &[("RADIUS", 3.0)])?;
//! gpu.submit(|encoder| rows.encode(encoder, &bound, rows.covering([width, height, 1]), 1, None));
//! let blurred = gpu.read_buffer(&out, size, bytemuck::pod_collect_to_vec::<u8, f32>)?;
//! ```

use std::borrow::Cow;

use super::Gpu;
use crate::diag::{Diagnostic, Failure, codes};
use crate::emit::Validated;
use crate::emit::reflect::{Dimension, Entry, Interface, Kind, Resource, Sampling, Stage, Texels};

/// A shader on a device, with the layouts that its text declares.
#[derive(Debug)]
pub(crate) struct Module {
    pub(super) label: String,
    pub(super) shader: wgpu::ShaderModule,
    pub(super) layout: wgpu::PipelineLayout,
    interface: Interface,
    /// By number; those between that the shader does not use are empty.
    groups: Vec<wgpu::BindGroupLayout>,
    varying: Option<Varying>,
}

/// A uniform of which each dispatch has another value.
#[derive(Debug)]
struct Varying {
    name: String,
    group: u32,
    /// The bytes of a value.
    size: u64,
}

/// Bytes from one record of a varying uniform to the next: what every device allows.
pub(crate) const RECORD: u64 = 256;

/// Resources by the names of the shader's variables.
#[derive(Debug, Default)]
pub(crate) struct Resources<'r>(Vec<Named<'r>>);

#[derive(Debug)]
struct Named<'r> {
    name: &'r str,
    resource: wgpu::BindingResource<'r>,
    optional: bool,
}

impl<'r> Resources<'r> {
    /// None yet.
    pub(crate) fn new() -> Self {
        Self::default()
    }

    /// A uniform or storage buffer.
    pub(crate) fn buffer(self, name: &'r str, buffer: &'r wgpu::Buffer) -> Self {
        self.with(name, buffer.as_entire_binding(), false)
    }

    /// A buffer for shaders that have the variable; nothing for those that do not.
    pub(crate) fn optional_buffer(self, name: &'r str, buffer: Option<&'r wgpu::Buffer>) -> Self {
        match buffer {
            Some(buffer) => self.with(name, buffer.as_entire_binding(), true),
            None => self,
        }
    }

    /// A sampled or a storage texture.
    #[cfg(any(feature = "render", test))]
    pub(crate) fn texture(self, name: &'r str, view: &'r wgpu::TextureView) -> Self {
        self.with(name, wgpu::BindingResource::TextureView(view), false)
    }

    /// A sampler.
    #[cfg(any(feature = "render", test))]
    pub(crate) fn sampler(self, name: &'r str, sampler: &'r wgpu::Sampler) -> Self {
        self.with(name, wgpu::BindingResource::Sampler(sampler), false)
    }

    fn with(mut self, name: &'r str, resource: wgpu::BindingResource<'r>, optional: bool) -> Self {
        self.0.push(Named { name, resource, optional });
        self
    }
}

/// The resources of a module, ready for every pass that is made of it.
#[derive(Debug)]
pub(crate) struct Bound {
    pub(super) groups: Vec<wgpu::BindGroup>,
    /// The group of the varying uniform.
    varying: Option<u32>,
}

impl Bound {
    /// The groups by number, each with the offsets for a record of the varying uniform.
    fn at(&self, record: u32) -> impl Iterator<Item = (u32, &wgpu::BindGroup, Option<u32>)> {
        let offset = move |number| (self.varying == Some(number)).then_some(record * RECORD as u32);
        (0..).zip(&self.groups).map(move |(number, group)| (number, group, offset(number)))
    }
}

/// Most workgroups along an axis, on every device.
#[cfg(any(feature = "render", test))]
const MOST_GROUPS: u32 = 65535;

/// A compute pipeline.
#[derive(Debug)]
pub(crate) struct Compute {
    pipeline: wgpu::ComputePipeline,
    workgroup: [u32; 3],
}

/// The number of workgroups of a dispatch.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Work<'w> {
    /// As many along each axis.
    Groups([u32; 3]),
    /// As many as the first three words of a buffer say when the dispatch begins.
    #[cfg_attr(not(feature = "render"), allow(dead_code))]
    Indirect(&'w wgpu::Buffer),
}

impl Module {
    /// Takes a shader to a device.
    ///
    /// # Errors
    /// When the device refuses the shader, or the shader wants what is not provided here.
    pub(crate) fn new(gpu: &Gpu, label: &str, validated: Validated) -> Result<Self, Failure> {
        Self::made(gpu, label, validated, None)
    }

    /// Takes a shader to a device of which each dispatch has its own value of a uniform, as long as so many bytes: the
    /// buffer that is bound to it holds a value every [`RECORD`] bytes.
    ///
    /// # Errors
    /// When the device refuses the shader, or the shader wants what is not provided here.
    #[cfg(any(feature = "render", test))]
    pub(crate) fn varying(
        gpu: &Gpu,
        label: &str,
        validated: Validated,
        (uniform, size): (&str, u64),
    ) -> Result<Self, Failure> {
        Self::made(gpu, label, validated, Some((uniform.to_owned(), size)))
    }

    fn made(gpu: &Gpu, label: &str, validated: Validated, varying: Option<(String, u64)>) -> Result<Self, Failure> {
        let device = &gpu.device;
        let interface = Interface::new(&validated).map_err(|reason| refused(label, &reason))?;
        let varying = varying.map(|(name, size)| {
            let group = interface.resources.iter().find(|resource| resource.name == name).map_or(0, |it| it.group);
            Varying { name, group, size }
        });
        let varies = |resource: &Resource| varying.as_ref().is_some_and(|varying| varying.name == resource.name);
        let source = wgpu::ShaderSource::Naga(Cow::Owned(validated.module));
        let name = Some(label);
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: name, source });
        let count = used(&interface).map(|(resource, _)| resource.group + 1).max().unwrap_or_default();
        let mut groups = Vec::new();
        for group in 0..count {
            let entries = used(&interface)
                .filter(|(resource, _)| resource.group == group)
                .map(|(resource, visibility)| {
                    layout_entry(resource, visibility, varies(resource)).map_err(|e| refused(label, &e))
                })
                .collect::<Result<Vec<_>, Failure>>()?;
            let descriptor = wgpu::BindGroupLayoutDescriptor { label: name, entries: &entries };
            groups.push(device.create_bind_group_layout(&descriptor));
        }
        let all: Vec<_> = groups.iter().map(Some).collect();
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: name,
            bind_group_layouts: &all,
            immediate_size: 0,
        });
        gpu.check()?;
        Ok(Self { label: label.to_owned(), shader, layout, interface, groups, varying })
    }

    /// Binds resources by name: all that some entry point uses. What the shader declares and does not use is left out.
    ///
    /// # Errors
    /// When a resource is missing, when the shader declares none of a name that is not optional, or when the device
    /// refuses one.
    pub(crate) fn bind(&self, gpu: &Gpu, resources: &Resources<'_>) -> Result<Bound, Failure> {
        let given = |name: &str| resources.0.iter().find(|given| given.name == name);
        let missing: Vec<&str> = used(&self.interface)
            .map(|(resource, _)| resource.name.as_str())
            .filter(|name| given(name).is_none())
            .collect();
        let declared = |name: &str| self.interface.resources.iter().any(|resource| resource.name == name);
        let surplus: Vec<&str> =
            resources.0.iter().filter(|it| !it.optional && !declared(it.name)).map(|it| it.name).collect();
        if let Some(message) = mismatch(&missing, &surplus) {
            let names: Vec<String> = self.interface.resources.iter().map(|it| format!("`{}`", it.name)).collect();
            let error = Diagnostic::error(codes::DEVICE, format!("the shader `{}` {message}", self.label))
                .help(format!("it declares: {}", names.join(", ")));
            return Err(Failure::bare("", error));
        }
        let groups = (0..).zip(&self.groups).map(|(group, layout)| {
            let entries: Vec<_> = used(&self.interface)
                .filter(|(resource, _)| resource.group == group)
                .filter_map(|(resource, _)| {
                    let mut resource_given = given(&resource.name)?.resource.clone();
                    if let (Some(varying), wgpu::BindingResource::Buffer(buffer)) = (&self.varying, &mut resource_given)
                        && varying.name == resource.name
                    {
                        buffer.size = wgpu::BufferSize::new(varying.size);
                    }
                    Some(wgpu::BindGroupEntry { binding: resource.binding, resource: resource_given })
                })
                .collect();
            let descriptor = wgpu::BindGroupDescriptor { label: Some(&self.label), layout, entries: &entries };
            gpu.device.create_bind_group(&descriptor)
        });
        let bound = Bound { groups: groups.collect(), varying: self.varying.as_ref().map(|varying| varying.group) };
        gpu.check()?;
        Ok(bound)
    }

    /// A compute pipeline of one of its entry points, with values for constants that can be overridden.
    ///
    /// # Errors
    /// When there is no such entry point, or the device refuses it.
    pub(crate) fn compute(&self, gpu: &Gpu, entry: &str, constants: &[(&str, f64)]) -> Result<Compute, Failure> {
        let workgroup = self.entry(entry, Stage::Compute)?.workgroup;
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(&self.label),
            layout: Some(&self.layout),
            module: &self.shader,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
            cache: None,
        });
        gpu.check()?;
        Ok(Compute { pipeline, workgroup })
    }

    /// The name of its only compute shader, whatever the emitter calls it.
    ///
    /// # Errors
    /// When there is none.
    pub(crate) fn only_compute(&self) -> Result<&str, Failure> {
        let found = self.interface.entries.iter().find(|entry| entry.stage == Stage::Compute);
        found.map(|entry| entry.name.as_str()).ok_or_else(|| refused(&self.label, "it has no compute shader"))
    }

    pub(super) fn entry(&self, name: &str, stage: Stage) -> Result<&Entry, Failure> {
        let found = self.interface.entry(name, stage);
        found.ok_or_else(|| refused(&self.label, &format!("it has no entry point `{name}` of this stage")))
    }
}

impl Compute {
    /// The workgroups that give a thread to each of so many items along each axis.
    pub(crate) fn covering(&self, items: [u32; 3]) -> Work<'static> {
        let mut groups = items;
        for (count, threads) in groups.iter_mut().zip(self.workgroup) {
            *count = count.div_ceil(threads.max(1));
        }
        Work::Groups(groups)
    }

    /// The workgroups that give a thread to each of so many items in a line, in as many rows as it takes: the shader
    /// counts workgroups row by row.
    #[cfg(any(feature = "render", test))]
    pub(crate) fn in_line(&self, items: u32) -> Work<'static> {
        let groups = items.div_ceil(self.workgroup.iter().product::<u32>().max(1)).max(1);
        let rows = groups.div_ceil(MOST_GROUPS);
        Work::Groups([groups.div_ceil(rows), rows, 1])
    }

    /// Encodes a pass of one dispatch for each of some records of a varying uniform, with these bindings in turn.
    #[cfg(any(feature = "render", test))]
    pub(crate) fn encode_records(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        bound: [&Bound; 2],
        work: Work<'_>,
        records: impl Iterator<Item = u32>,
        timestamp_writes: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) {
        let descriptor = wgpu::ComputePassDescriptor { label: None, timestamp_writes };
        let mut pass = encoder.begin_compute_pass(&descriptor);
        pass.set_pipeline(&self.pipeline);
        for (turn, record) in records.enumerate() {
            for (number, group, offset) in bound[turn % 2].at(record) {
                pass.set_bind_group(number, group, offset.as_slice());
            }
            match work {
                Work::Groups([x, y, z]) => pass.dispatch_workgroups(x, y, z),
                Work::Indirect(buffer) => pass.dispatch_workgroups_indirect(buffer, 0),
            }
        }
    }

    /// Encodes a pass of `repeats` equal dispatches.
    pub(crate) fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        bound: &Bound,
        work: Work<'_>,
        repeats: u32,
        timestamp_writes: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) {
        let descriptor = wgpu::ComputePassDescriptor { label: None, timestamp_writes };
        let mut pass = encoder.begin_compute_pass(&descriptor);
        pass.set_pipeline(&self.pipeline);
        for (number, group, offset) in bound.at(0) {
            pass.set_bind_group(number, group, offset.as_slice());
        }
        for _ in 0..repeats {
            match work {
                Work::Groups([x, y, z]) => pass.dispatch_workgroups(x, y, z),
                Work::Indirect(buffer) => pass.dispatch_workgroups_indirect(buffer, 0),
            }
        }
    }
}

/// The resources that some entry point uses, each with the stages that do.
fn used(interface: &Interface) -> impl Iterator<Item = (&Resource, wgpu::ShaderStages)> {
    interface.resources.iter().enumerate().filter_map(|(index, resource)| {
        let mut stages = wgpu::ShaderStages::empty();
        for entry in interface.entries.iter().filter(|entry| entry.uses.contains(&index)) {
            stages |= match entry.stage {
                Stage::Vertex => wgpu::ShaderStages::VERTEX,
                Stage::Fragment => wgpu::ShaderStages::FRAGMENT,
                Stage::Compute => wgpu::ShaderStages::COMPUTE,
            };
        }
        (!stages.is_empty()).then_some((resource, stages))
    })
}

/// The complaint about missing and surplus resources, if any.
fn mismatch(missing: &[&str], surplus: &[&str]) -> Option<String> {
    let list = |names: &[&str]| names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    match (missing.is_empty(), surplus.is_empty()) {
        (true, true) => None,
        (false, true) => Some(format!("uses {}, which nothing was bound to", list(missing))),
        (true, false) => Some(format!("does not declare {}", list(surplus))),
        (false, false) => {
            let (missing, surplus) = (list(missing), list(surplus));
            Some(format!("uses {missing}, which nothing was bound to, and does not declare {surplus}"))
        }
    }
}

fn refused(label: &str, reason: &str) -> Failure {
    let headline = format!("the shader `{label}` cannot be made into a pass: {reason}");
    Failure::bare("", Diagnostic::error(codes::DEVICE, headline).help("please report this"))
}

fn layout_entry(
    resource: &Resource,
    visibility: wgpu::ShaderStages,
    has_dynamic_offset: bool,
) -> Result<wgpu::BindGroupLayoutEntry, String> {
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset, min_binding_size: None };
    let ty = match &resource.kind {
        Kind::Uniform => buffer(wgpu::BufferBindingType::Uniform),
        Kind::Storage { writable } => buffer(wgpu::BufferBindingType::Storage { read_only: !writable }),
        Kind::Texture { texels, dimension, multisampled } => wgpu::BindingType::Texture {
            sample_type: match *texels {
                Texels::Float { filtered: filterable } => wgpu::TextureSampleType::Float { filterable },
                Texels::Sint => wgpu::TextureSampleType::Sint,
                Texels::Uint => wgpu::TextureSampleType::Uint,
                Texels::Depth => wgpu::TextureSampleType::Depth,
            },
            view_dimension: view_dimension(*dimension),
            multisampled: *multisampled,
        },
        Kind::StorageTexture { format, reads, writes, dimension } => wgpu::BindingType::StorageTexture {
            access: match (*reads, *writes) {
                (true, true) => wgpu::StorageTextureAccess::ReadWrite,
                (true, false) => wgpu::StorageTextureAccess::ReadOnly,
                (false, _) => wgpu::StorageTextureAccess::WriteOnly,
            },
            format: *STORED
                .iter()
                .find(|known| format!("{known:?}") == *format)
                .ok_or_else(|| format!("storage textures of the format {format} are not provided"))?,
            view_dimension: view_dimension(*dimension),
        },
        Kind::Sampler(sampling) => wgpu::BindingType::Sampler(match sampling {
            Sampling::Nearest => wgpu::SamplerBindingType::NonFiltering,
            Sampling::Filtering => wgpu::SamplerBindingType::Filtering,
            Sampling::Comparison => wgpu::SamplerBindingType::Comparison,
        }),
    };
    Ok(wgpu::BindGroupLayoutEntry { binding: resource.binding, visibility, ty, count: None })
}

/// The formats of storage textures that WebGPU has everywhere.
const STORED: [wgpu::TextureFormat; 16] = [
    wgpu::TextureFormat::Rgba8Unorm,
    wgpu::TextureFormat::Rgba8Snorm,
    wgpu::TextureFormat::Rgba8Uint,
    wgpu::TextureFormat::Rgba8Sint,
    wgpu::TextureFormat::Rgba16Uint,
    wgpu::TextureFormat::Rgba16Sint,
    wgpu::TextureFormat::Rgba16Float,
    wgpu::TextureFormat::R32Uint,
    wgpu::TextureFormat::R32Sint,
    wgpu::TextureFormat::R32Float,
    wgpu::TextureFormat::Rg32Uint,
    wgpu::TextureFormat::Rg32Sint,
    wgpu::TextureFormat::Rg32Float,
    wgpu::TextureFormat::Rgba32Uint,
    wgpu::TextureFormat::Rgba32Sint,
    wgpu::TextureFormat::Rgba32Float,
];

fn view_dimension(dimension: Dimension) -> wgpu::TextureViewDimension {
    match dimension {
        Dimension::D1 => wgpu::TextureViewDimension::D1,
        Dimension::D2 => wgpu::TextureViewDimension::D2,
        Dimension::D2Array => wgpu::TextureViewDimension::D2Array,
        Dimension::D3 => wgpu::TextureViewDimension::D3,
        Dimension::Cube => wgpu::TextureViewDimension::Cube,
        Dimension::CubeArray => wgpu::TextureViewDimension::CubeArray,
    }
}
