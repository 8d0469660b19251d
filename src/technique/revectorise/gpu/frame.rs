//! Shadow map and receivers as textures.

use crate::diag::{Diagnostic, Failure, codes};
use crate::gpu::{Gpu, TextureFormat, TextureView};
use crate::technique::revectorise::{Receivers, ShadowMap};

/// Depth beyond everything: the border of the map, where all is lit.
const FAR: f32 = f32::MAX;

/// A shadow map and receivers on a device.
#[derive(Debug)]
pub struct GpuFrame {
    /// Texels per side of the map.
    pub(super) size: u32,
    /// Pixels of the picture.
    pub(super) pixels: [u32; 2],
    pub(super) map: TextureView,
    pub(super) points: TextureView,
    pub(super) slopes: TextureView,
}

impl GpuFrame {
    /// Copies a frame to a device.
    ///
    /// # Errors
    /// When map or picture are empty, or larger than the device allows.
    pub fn new(gpu: &Gpu, map: &ShadowMap, receivers: &Receivers) -> Result<Self, Failure> {
        check_map(gpu, map.size)?;
        check_picture(gpu, receivers.width, receivers.height)?;
        let side = map.size as usize;
        let mut depths = vec![FAR; (side + 2) * (side + 2)];
        for (row, texels) in map.depth.chunks_exact(side).enumerate().take(side) {
            let start = (row + 1) * (side + 2) + 1;
            depths[start..start + side].copy_from_slice(texels);
        }
        let mut points = Vec::with_capacity(4 * receivers.points.len());
        let mut slopes = Vec::with_capacity(2 * receivers.points.len());
        for receiver in &receivers.points {
            points.extend([receiver.u, receiver.v, receiver.z, receiver.kind as u32 as f32]);
            slopes.extend([receiver.dz_dx, receiver.dz_dy]);
        }
        let pixels = [receivers.width, receivers.height];
        let frame = Self {
            size: map.size,
            pixels,
            map: gpu.texture("shadow map", [map.size + 2; 2], TextureFormat::R32Float, &depths),
            points: gpu.texture("receivers", pixels, TextureFormat::Rgba32Float, &points),
            slopes: gpu.texture("slopes", pixels, TextureFormat::Rg32Float, &slopes),
        };
        gpu.check()?;
        Ok(frame)
    }

    /// The number of pixels of the picture.
    pub(super) fn pixel_count(&self) -> usize {
        self.pixels[0] as usize * self.pixels[1] as usize
    }
}

/// Fails if the device has no shadow map of this size.
///
/// # Errors
/// With the sizes that it has.
pub(super) fn check_map(gpu: &Gpu, size: u32) -> Result<(), Failure> {
    // The border takes a texel on each side.
    let most = gpu.device.limits().max_texture_dimension_2d - 2;
    if size == 0 || size > most {
        let error = Diagnostic::error(codes::DEVICE, format!("a shadow map of {size} × {size} texels cannot be made"))
            .help(format!("on {} the side may be 1 to {most} texels", gpu.describe()));
        return Err(Failure::bare("", error));
    }
    Ok(())
}

/// Fails if the device has no picture of this size.
///
/// # Errors
/// With the sizes that it has.
pub(super) fn check_picture(gpu: &Gpu, width: u32, height: u32) -> Result<(), Failure> {
    let limits = gpu.device.limits();
    let side = limits.max_texture_dimension_2d;
    // The widest thing that is stored for a pixel takes four words.
    let most = (limits.max_storage_buffer_binding_size / 16).min(limits.max_buffer_size / 16);
    if width == 0 || height == 0 || width > side || height > side || u64::from(width) * u64::from(height) > most {
        let error = Diagnostic::error(codes::DEVICE, format!("a picture of {width} × {height} pixels cannot be made"))
            .help(format!("on {} each side may be 1 to {side} pixels, and both together {most}", gpu.describe()));
        return Err(Failure::bare("", error));
    }
    Ok(())
}
