//! One picture into a file, for machines without a display.

use std::path::Path;

use image::RgbaImage;
use umbrage::scene::Scene;
use umbrage::text::file;

use crate::feedback::CASES;
use crate::gpu::Gpu;
use crate::panel;
use crate::renderer::Renderer;
use crate::shaders::Table;
use crate::view::View;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Renders a view of a scene into a file, and says what it took.
pub(crate) fn write(
    path: &Path,
    scene: &Scene,
    texels: u32,
    table: Option<&Path>,
    view: &View,
    size: [u32; 2],
    hits: Option<&Path>,
) -> Result<(), String> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let gpu = Gpu::open(&instance, None)?;
    let most = gpu.device.limits().max_texture_dimension_2d;
    if size.iter().any(|side| *side > most) {
        return Err(format!("error: a picture has at most {most} pixels per side on {}", gpu.name()));
    }
    let mut renderer = Renderer::new(gpu, scene, texels, FORMAT)?;
    if let Some(table) = table {
        renderer.take_table(table, view)?;
    }
    renderer.resize(size);
    let [width, height] = size;
    let target = renderer.gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let output = target.create_view(&wgpu::TextureViewDescriptor::default());
    renderer.render(view, &output)?;
    let picture = read(&renderer.gpu, &target)?;
    // The times of the first frame are those of the driver's compiler.
    renderer.collector.take(&renderer.gpu, wgpu::PollType::wait_indefinitely());
    renderer.render(view, &output)?;
    let feedback = renderer.collector.take(&renderer.gpu, wgpu::PollType::wait_indefinitely());
    // The format is PNG, whatever the file is called. All of the picture is in the file, or nothing.
    let mut png = std::io::Cursor::new(Vec::new());
    let written = picture.write_to(&mut png, image::ImageFormat::Png);
    written.map_err(|error| format!("error: {} cannot be written: {error}", file::shown(path)))?;
    file::write(path, png.get_ref()).map_err(|failure| failure.to_string())?;
    println!("{}: {}", path.display(), panel::title(view, &renderer, feedback.as_ref()));
    if let Some(path) = hits {
        count(&mut renderer, view, &output, path)?;
    }
    if view.cases
        && let Some(feedback) = feedback
    {
        panel::legend(view, &renderer, &feedback.counts).iter().for_each(|entry| println!("{entry}"));
    }
    Ok(())
}

/// Renders once more, by the table that counts, and writes how often each of its lines gave a result.
fn count(renderer: &mut Renderer, view: &View, output: &wgpu::TextureView, path: &Path) -> Result<(), String> {
    let Some(lines) = renderer.tables.of(view.technique).and_then(Table::lines).filter(|lines| *lines <= CASES) else {
        return Err(format!("error: {} has no table, or one of more than {CASES} lines", view.technique));
    };
    let mut view = *view;
    view.hits = true;
    renderer.render(&view, output)?;
    let feedback = renderer.collector.take(&renderer.gpu, wgpu::PollType::wait_indefinitely());
    let counts = feedback.ok_or("error: the counts were lost")?.counts;
    let text: String = counts[..lines].iter().map(|count| format!("{count}\n")).collect();
    file::write(path, text.as_bytes()).map_err(|failure| failure.to_string())
}

/// The pixels of a texture.
fn read(gpu: &Gpu, texture: &wgpu::Texture) -> Result<RgbaImage, String> {
    let (width, height) = (texture.width(), texture.height());
    let row = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("pixels"),
        size: u64::from(row) * u64::from(height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
    let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
    gpu.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |_| {});
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| format!("error: {error}"))?;
    let bytes = buffer.get_mapped_range(..).map_err(|error| format!("error: the picture was lost: {error}"))?;
    let pixels = bytes.chunks(row as usize).flat_map(|bytes| bytes[..4 * width as usize].to_vec()).collect();
    RgbaImage::from_raw(width, height, pixels).ok_or_else(|| "error: the picture was lost".to_owned())
}
