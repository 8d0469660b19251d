//! Buffers and textures: made from what the host has, and read back.

use std::fmt;
use std::sync::mpsc;

#[cfg(any(feature = "render", test))]
use encase::ShaderType;
#[cfg(any(feature = "render", test))]
use encase::internal::WriteInto;
use wgpu::util::DeviceExt;

use super::Gpu;
#[cfg(any(feature = "render", test))]
use super::pass::RECORD;
use crate::diag::{Diagnostic, Failure, codes};

impl Gpu {
    /// A storage buffer of words, or of the bytes of structures.
    pub(crate) fn storage<T: bytemuck::NoUninit>(&self, label: &str, contents: &[T]) -> wgpu::Buffer {
        self.filled(label, bytemuck::cast_slice(contents), wgpu::BufferUsages::STORAGE)
    }

    /// A storage buffer of zeros that shaders write and that is read back.
    pub(crate) fn results(&self, label: &str, size: u64) -> wgpu::Buffer {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        self.empty(label, size, usage)
    }

    pub(super) fn filled(&self, label: &str, contents: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
    }

    pub(super) fn empty(&self, label: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let label = Some(label);
        self.device.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false })
    }

    /// Encodes commands and submits them.
    pub(crate) fn submit(&self, encode: impl FnOnce(&mut wgpu::CommandEncoder)) {
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encode(&mut encoder);
        self.queue.submit([encoder.finish()]);
    }

    /// Waits for the device, then shows the contents of a mappable buffer.
    ///
    /// # Errors
    /// When the device was lost, ran out of memory, or found fault with what was submitted.
    pub(super) fn read_back<R>(&self, buffer: &wgpu::Buffer, read: impl FnOnce(&[u8]) -> R) -> Result<R, Failure> {
        let (sender, receiver) = mpsc::channel();
        buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
            // The receiver only goes away after an error that was reported already.
            let _ = sender.send(result);
        });
        let failed = |what: &dyn fmt::Display| {
            let message = format!("results could not be read back: {what}");
            let help = "try fewer rows or pixels, or another adapter (`--adapter`)";
            Failure::bare("", Diagnostic::error(codes::DEVICE, message).help(help))
        };
        self.wait()?;
        receiver.recv().map_err(|error| failed(&error))?.map_err(|error| failed(&error))?;
        let result = {
            let view = buffer.slice(..).get_mapped_range().map_err(|error| failed(&error))?;
            read(&view)
        };
        buffer.unmap();
        Ok(result)
    }

    /// Copies the first bytes of a buffer back and shows them.
    ///
    /// # Errors
    /// When the device fails.
    pub(crate) fn read_buffer<R>(
        &self,
        source: &wgpu::Buffer,
        size: u64,
        read: impl FnOnce(&[u8]) -> R,
    ) -> Result<R, Failure> {
        let back = self.mappable(size);
        self.submit(|encoder| encoder.copy_buffer_to_buffer(source, 0, &back, 0, size));
        self.read_back(&back, read)
    }

    fn mappable(&self, size: u64) -> wgpu::Buffer {
        self.empty("back", size, wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST)
    }
}

/// For passes that render.
#[cfg(any(feature = "render", test))]
impl Gpu {
    /// A uniform buffer, laid out as the structure of the same fields in WGSL.
    ///
    /// # Errors
    /// When the structure cannot be laid out.
    pub(crate) fn uniform(&self, label: &str, value: &(impl ShaderType + WriteInto)) -> Result<wgpu::Buffer, Failure> {
        let mut buffer = encase::UniformBuffer::new(Vec::new());
        buffer.write(value).map_err(|error| unwritable(label, &error))?;
        Ok(self.filled(label, &buffer.into_inner(), wgpu::BufferUsages::UNIFORM))
    }

    /// A uniform buffer of records: values of a uniform, each laid out as the structure of the same fields in WGSL.
    ///
    /// # Errors
    /// When the structure cannot be laid out.
    pub(crate) fn records<T: ShaderType + WriteInto>(
        &self,
        label: &str,
        values: &[T],
    ) -> Result<wgpu::Buffer, Failure> {
        let mut bytes = vec![0; values.len().max(1) * RECORD as usize];
        for (value, place) in values.iter().zip(bytes.chunks_mut(RECORD as usize)) {
            let mut buffer = encase::UniformBuffer::new(Vec::new());
            buffer.write(value).map_err(|error| unwritable(label, &error))?;
            let value = buffer.into_inner();
            place[..value.len()].copy_from_slice(&value);
        }
        Ok(self.filled(label, &bytes, wgpu::BufferUsages::UNIFORM))
    }

    /// A buffer for the numbers of workgroups of an indirect dispatch, written by copying.
    pub(crate) fn indirect(&self, label: &str, size: u64) -> wgpu::Buffer {
        self.empty(label, size, wgpu::BufferUsages::INDIRECT | wgpu::BufferUsages::COPY_DST)
    }

    /// Words to be copied into other buffers.
    pub(crate) fn words(&self, label: &str, words: &[u32]) -> wgpu::Buffer {
        self.filled(label, bytemuck::cast_slice(words), wgpu::BufferUsages::COPY_SRC)
    }

    /// A sampler that takes the nearest texel, outside the nearest one of the border.
    pub(crate) fn nearest(&self) -> wgpu::Sampler {
        self.device.create_sampler(&wgpu::SamplerDescriptor::default())
    }

    /// A texture of these texels, row by row.
    pub(crate) fn texture(
        &self,
        label: &str,
        size: [u32; 2],
        format: wgpu::TextureFormat,
        texels: &[f32],
    ) -> wgpu::TextureView {
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let descriptor = flat(label, size, format, usage);
        let order = wgpu::util::TextureDataOrder::LayerMajor;
        let data = bytemuck::cast_slice(texels);
        view(&self.device.create_texture_with_data(&self.queue, &descriptor, order, data))
    }

    /// A texture that passes draw to, and that is read back.
    pub(crate) fn target(&self, label: &str, size: [u32; 2], format: wgpu::TextureFormat) -> wgpu::Texture {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        self.device.create_texture(&flat(label, size, format, usage))
    }

    /// A texture that shaders store to, and that later ones load from.
    #[cfg(test)]
    pub(crate) fn stored(&self, label: &str, size: [u32; 2], format: wgpu::TextureFormat) -> wgpu::Texture {
        let usage =
            wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
        self.device.create_texture(&flat(label, size, format, usage))
    }

    /// Copies a texture back, row by row.
    ///
    /// # Errors
    /// When the device fails.
    pub(crate) fn read_texture<T: bytemuck::Pod>(&self, source: &wgpu::Texture) -> Result<Vec<T>, Failure> {
        let width = source.width() as usize * size_of::<T>();
        let pitch = (width as u32).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let back = self.mappable(u64::from(pitch) * u64::from(source.height()));
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(pitch), rows_per_image: None };
        let target = wgpu::TexelCopyBufferInfo { buffer: &back, layout };
        self.submit(|encoder| encoder.copy_texture_to_buffer(source.as_image_copy(), target, source.size()));
        self.read_back(&back, |bytes| {
            let rows = bytes.chunks(pitch as usize).map(|row| bytemuck::pod_collect_to_vec::<u8, T>(&row[..width]));
            rows.flatten().collect()
        })
    }
}

/// All of a texture.
#[cfg(any(feature = "render", test))]
pub(crate) fn view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// The bytes of structures in a storage buffer, laid out as in WGSL.
///
/// # Errors
/// When they cannot be laid out.
#[cfg(any(feature = "render", test))]
pub(crate) fn laid_out<T: ShaderType + WriteInto>(label: &str, value: &T) -> Result<Vec<u8>, Failure> {
    let mut buffer = encase::StorageBuffer::new(Vec::new());
    buffer.write(value).map_err(|error| unwritable(label, &error))?;
    let mut bytes = buffer.into_inner();
    // Padding behind the last field is not written, and the shader counts it.
    bytes.resize(value.size().get() as usize, 0);
    Ok(bytes)
}

#[cfg(any(feature = "render", test))]
fn unwritable(label: &str, error: &encase::internal::Error) -> Failure {
    let message = format!("the structure `{label}` cannot be laid out for a device: {error}");
    Failure::bare("", Diagnostic::error(codes::DEVICE, message).help("please report this"))
}

#[cfg(any(feature = "render", test))]
fn flat(
    label: &str,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::TextureDescriptor<'_> {
    wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    }
}
