//! The interface of a validated module: the resources that it declares, and
//! its entry points with what each of them uses.
//!
//! Pipelines are made from this, so that a layout is written once, in the shader.

#![allow(clippy::wildcard_enum_match_arm, reason = "types are those of naga, of which shaders here use few")]

use std::collections::HashSet;

use naga::{AddressSpace, Binding, Expression, Handle, ImageClass, ScalarKind, StorageAccess, TypeInner};

use super::Validated;

/// The resources that a module asks of its host.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Interface {
    /// The declared variables that the host binds.
    pub resources: Vec<Resource>,
    /// The entry points.
    pub entries: Vec<Entry>,
}

/// A variable that the host binds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Resource {
    /// Its name. In GLSL, the name of the only member of a block without a name.
    pub name: String,
    /// The number of its group.
    pub group: u32,
    /// Its number in the group.
    pub binding: u32,
    /// Its kind.
    pub kind: Kind,
}

/// A kind of resource.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Kind {
    /// A uniform buffer.
    Uniform,
    /// A storage buffer.
    Storage {
        /// True if shaders may write to it.
        writable: bool,
    },
    /// A texture that is loaded from, gathered from, or sampled.
    Texture {
        /// The kind of its texels.
        texels: Texels,
        /// Its dimension.
        dimension: Dimension,
        /// True if a texel has several samples.
        multisampled: bool,
    },
    /// A texture whose texels are read or written without a sampler.
    StorageTexture {
        /// The format, as naga spells it: `Rgba8Unorm`.
        format: String,
        /// True if shaders read it.
        reads: bool,
        /// True if shaders write it.
        writes: bool,
        /// Its dimension.
        dimension: Dimension,
    },
    /// A sampler.
    Sampler(Sampling),
}

/// The texels of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Texels {
    /// Numbers.
    Float {
        /// True if some function samples it, so that neighbours may be mixed.
        filtered: bool,
    },
    /// Signed integers.
    Sint,
    /// Unsigned integers.
    Uint,
    /// Depths.
    Depth,
}

/// The use of a sampler.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sampling {
    /// Gathers only.
    Nearest,
    /// Mixes neighbours.
    Filtering,
    /// Compares depths.
    Comparison,
}

/// The dimension of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// A row.
    D1,
    /// A picture.
    D2,
    /// Several pictures.
    D2Array,
    /// A block.
    D3,
    /// The faces of a cube.
    Cube,
    /// Several cubes.
    CubeArray,
}

/// An entry point.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// Its name.
    pub name: String,
    /// Its stage.
    pub stage: Stage,
    /// Threads of a workgroup; zeros if it is not a compute shader.
    pub workgroup: [u32; 3],
    /// The resources that it uses, as indices into [`Interface::resources`].
    pub uses: Vec<usize>,
    /// The attributes of a vertex shader's corners.
    pub attributes: Vec<Attribute>,
}

/// A stage of a pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Corners of triangles.
    Vertex,
    /// Pixels.
    Fragment,
    /// Neither.
    Compute,
}

/// A number or vector of each corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Attribute {
    /// Its number.
    pub location: u32,
    /// The kind of its components.
    pub kind: AttributeKind,
    /// The number of its components.
    pub components: u8,
}

/// The kind of an attribute's components, each of 32 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AttributeKind {
    /// `f32`.
    Float,
    /// `i32`.
    Sint,
    /// `u32`.
    Uint,
}

impl Interface {
    /// Reads a module.
    ///
    /// # Errors
    /// With the first thing that pipelines here do not provide.
    pub fn new(validated: &Validated) -> Result<Self, String> {
        let module = &validated.module;
        let filtered = filtered(module);
        let mut resources = Vec::new();
        let mut handles = Vec::new();
        for (handle, global) in module.global_variables.iter() {
            let Some(binding) = global.binding else { continue };
            let ty = &module.types[global.ty];
            let name = match (&global.name, &ty.inner) {
                (Some(name), _) => name.clone(),
                (None, TypeInner::Struct { members, .. }) if members.len() == 1 => {
                    members[0].name.clone().unwrap_or_default()
                }
                (None, _) => ty.name.clone().unwrap_or_default(),
            };
            let kind = kind(global.space, &ty.inner, filtered.contains(&handle))
                .ok_or_else(|| format!("the variable `{name}` is of a kind that is not provided"))?;
            resources.push(Resource { name, group: binding.group, binding: binding.binding, kind });
            handles.push(handle);
        }
        let mut entries = Vec::new();
        for (index, entry) in module.entry_points.iter().enumerate() {
            let stage = match entry.stage {
                naga::ShaderStage::Vertex => Stage::Vertex,
                naga::ShaderStage::Fragment => Stage::Fragment,
                naga::ShaderStage::Compute => Stage::Compute,
                naga::ShaderStage::Task
                | naga::ShaderStage::Mesh
                | naga::ShaderStage::RayGeneration
                | naga::ShaderStage::Miss
                | naga::ShaderStage::AnyHit
                | naga::ShaderStage::ClosestHit => {
                    return Err(format!("the entry point `{}` is of a stage that is not provided", entry.name));
                }
            };
            let info = validated.info.get_entry_point(index);
            let uses = (0..handles.len()).filter(|index| !info[handles[*index]].is_empty()).collect();
            let attributes = if stage == Stage::Vertex { attributes(module, entry)? } else { Vec::new() };
            let workgroup = entry.workgroup_size;
            entries.push(Entry { name: entry.name.clone(), stage, workgroup, uses, attributes });
        }
        Ok(Self { resources, entries })
    }

    /// The entry point of a name and a stage.
    pub fn entry(&self, name: &str, stage: Stage) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.stage == stage && entry.name == name)
    }
}

/// The textures and samplers that are sampled, other than gathered from.
fn filtered(module: &naga::Module) -> HashSet<Handle<naga::GlobalVariable>> {
    let functions = module.functions.iter().map(|(_, function)| function);
    let mut found = HashSet::new();
    for function in functions.chain(module.entry_points.iter().map(|entry| &entry.function)) {
        for (_, expression) in function.expressions.iter() {
            if let Expression::ImageSample { image, sampler, gather: None, .. } = expression {
                for operand in [image, sampler] {
                    if let Expression::GlobalVariable(global) = function.expressions[*operand] {
                        found.insert(global);
                    }
                }
            }
        }
    }
    found
}

fn kind(space: AddressSpace, ty: &TypeInner, filtered: bool) -> Option<Kind> {
    if space == AddressSpace::Uniform {
        return Some(Kind::Uniform);
    }
    if let AddressSpace::Storage { access } = space {
        return Some(Kind::Storage { writable: access.contains(StorageAccess::STORE) });
    }
    match *ty {
        TypeInner::Sampler { comparison: true } => Some(Kind::Sampler(Sampling::Comparison)),
        TypeInner::Sampler { comparison: false } if filtered => Some(Kind::Sampler(Sampling::Filtering)),
        TypeInner::Sampler { comparison: false } => Some(Kind::Sampler(Sampling::Nearest)),
        TypeInner::Image { dim, arrayed, class } => {
            let dimension = match (dim, arrayed) {
                (naga::ImageDimension::D1, _) => Dimension::D1,
                (naga::ImageDimension::D2, false) => Dimension::D2,
                (naga::ImageDimension::D2, true) => Dimension::D2Array,
                (naga::ImageDimension::D3, _) => Dimension::D3,
                (naga::ImageDimension::Cube, false) => Dimension::Cube,
                (naga::ImageDimension::Cube, true) => Dimension::CubeArray,
            };
            match class {
                ImageClass::Sampled { kind, multi: multisampled } => {
                    let texels = match kind {
                        ScalarKind::Float => Texels::Float { filtered },
                        ScalarKind::Sint => Texels::Sint,
                        ScalarKind::Uint => Texels::Uint,
                        ScalarKind::Bool | ScalarKind::AbstractInt | ScalarKind::AbstractFloat => return None,
                    };
                    Some(Kind::Texture { texels, dimension, multisampled })
                }
                ImageClass::Depth { multi: multisampled } => {
                    Some(Kind::Texture { texels: Texels::Depth, dimension, multisampled })
                }
                ImageClass::Storage { format, access } => Some(Kind::StorageTexture {
                    format: format!("{format:?}"),
                    reads: access.contains(StorageAccess::LOAD),
                    writes: access.contains(StorageAccess::STORE),
                    dimension,
                }),
                ImageClass::External => None,
            }
        }
        _ => None,
    }
}

/// The attributes that a vertex shader takes, in the order of its text.
fn attributes(module: &naga::Module, entry: &naga::EntryPoint) -> Result<Vec<Attribute>, String> {
    let mut found = Vec::new();
    let mut take = |binding: &Option<Binding>, ty: Handle<naga::Type>| -> Result<(), String> {
        let Some(Binding::Location { location, .. }) = *binding else { return Ok(()) };
        let (scalar, components) = match module.types[ty].inner {
            TypeInner::Scalar(scalar) => (scalar, 1),
            TypeInner::Vector { size, scalar } => (scalar, size as u8),
            _ => return Err(format!("the attribute {location} of `{}` is no number", entry.name)),
        };
        let kind = match (scalar.kind, scalar.width) {
            (ScalarKind::Float, 4) => AttributeKind::Float,
            (ScalarKind::Sint, 4) => AttributeKind::Sint,
            (ScalarKind::Uint, 4) => AttributeKind::Uint,
            _ => return Err(format!("the attribute {location} of `{}` is not of 32 bits", entry.name)),
        };
        found.push(Attribute { location, kind, components });
        Ok(())
    };
    for argument in &entry.function.arguments {
        take(&argument.binding, argument.ty)?;
        if let TypeInner::Struct { members, .. } = &module.types[argument.ty].inner {
            for member in members {
                take(&member.binding, member.ty)?;
            }
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emit::wgsl_text;

    #[test]
    fn an_interface_is_read_from_the_text() {
        let text = "
            struct Settings { scale: f32 }
            @group(0) @binding(0) var<uniform> settings: Settings;
            @group(0) @binding(2) var picture: texture_2d<f32>;
            @group(0) @binding(3) var smooth_one: sampler;
            @group(1) @binding(0) var<storage, read_write> out: array<f32>;
            @group(1) @binding(1) var<storage> unused: array<u32>;
            @group(1) @binding(4) var painted: texture_storage_2d<rgba8unorm, write>;
            fn scale() -> f32 { return settings.scale; }
            @compute @workgroup_size(8, 4) fn first() { out[0] = scale(); }
            @compute @workgroup_size(64) fn second() { textureStore(painted, vec2(0), vec4(1.0)); }
            struct Corner { @location(1) place: vec3<f32>, @location(0) face: u32 }
            @vertex fn place(corner: Corner) -> @builtin(position) vec4<f32> { return vec4(corner.place, 1.0); }
            @fragment fn paint() -> @location(0) vec4<f32> { return textureSample(picture, smooth_one, vec2(0.5)); }";
        let validated = wgsl_text("test", text).unwrap_or_else(|e| panic!("{e}"));
        let interface = Interface::new(&validated).unwrap_or_else(|e| panic!("{e}"));
        let named = |name: &str| interface.resources.iter().find(|resource| resource.name == name);
        let place = |name: &str| named(name).map(|resource| (resource.group, resource.binding));
        assert_eq!(place("painted"), Some((1, 4)));
        assert_eq!(named("settings").map(|it| it.kind.clone()), Some(Kind::Uniform));
        assert_eq!(named("out").map(|it| it.kind.clone()), Some(Kind::Storage { writable: true }));
        assert_eq!(named("smooth_one").map(|it| it.kind.clone()), Some(Kind::Sampler(Sampling::Filtering)));
        let texels = Texels::Float { filtered: true };
        let kind = Kind::Texture { texels, dimension: Dimension::D2, multisampled: false };
        assert_eq!(named("picture").map(|it| it.kind.clone()), Some(kind));
        let uses = |name: &str, stage| {
            let entry = interface.entry(name, stage).unwrap_or_else(|| panic!("{name}"));
            let names = entry.uses.iter().map(|index| interface.resources[*index].name.as_str());
            (entry.workgroup, names.collect::<Vec<_>>())
        };
        assert_eq!(uses("first", Stage::Compute), ([8, 4, 1], vec!["settings", "out"]));
        assert_eq!(uses("second", Stage::Compute), ([64, 1, 1], vec!["painted"]));
        assert!(interface.entry("first", Stage::Vertex).is_none());
        let corner = interface.entry("place", Stage::Vertex).map(|entry| entry.attributes.clone());
        let attribute = |location, kind, components| Attribute { location, kind, components };
        let expected = vec![attribute(1, AttributeKind::Float, 3), attribute(0, AttributeKind::Uint, 1)];
        assert_eq!(corner, Some(expected));
    }
}
