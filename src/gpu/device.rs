//! Adapters and devices.

use std::fmt;
use std::str::FromStr;
use std::sync::{Arc, Mutex, PoisonError};

use crate::diag::{Diagnostic, Failure, codes};

/// The adapter to use.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum AdapterChoice {
    /// The best there is: a discrete GPU, else an integrated one, else software.
    #[default]
    Any,
    /// A software rasteriser.
    Software,
    /// Anything but a software rasteriser.
    Hardware,
    /// The first whose name contains this, in any case.
    Named(String),
}

impl FromStr for AdapterChoice {
    type Err = std::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text {
            "any" => AdapterChoice::Any,
            "software" => AdapterChoice::Software,
            "hardware" => AdapterChoice::Hardware,
            name => AdapterChoice::Named(name.to_owned()),
        })
    }
}

impl fmt::Display for AdapterChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            AdapterChoice::Any => "any",
            AdapterChoice::Software => "software",
            AdapterChoice::Hardware => "hardware",
            AdapterChoice::Named(name) => name,
        })
    }
}

impl AdapterChoice {
    fn admits(&self, info: &wgpu::AdapterInfo) -> bool {
        let software = info.device_type == wgpu::DeviceType::Cpu;
        match self {
            AdapterChoice::Any => true,
            AdapterChoice::Software => software,
            AdapterChoice::Hardware => !software,
            AdapterChoice::Named(name) => info.name.to_lowercase().contains(&name.to_lowercase()),
        }
    }
}

/// An open device.
#[derive(Debug)]
pub struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    info: wgpu::AdapterInfo,
    /// The first thing that went wrong on the device since the last look.
    trouble: Arc<Mutex<Option<String>>>,
}

impl Gpu {
    /// Opens a device on an adapter.
    ///
    /// # Errors
    /// When there is no such adapter, or it refuses to give a device.
    pub fn open(choice: &AdapterChoice) -> Result<Self, Failure> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
        let rank = |info: &wgpu::AdapterInfo| match info.device_type {
            wgpu::DeviceType::DiscreteGpu => 0,
            wgpu::DeviceType::IntegratedGpu => 1,
            wgpu::DeviceType::VirtualGpu => 2,
            wgpu::DeviceType::Other => 3,
            wgpu::DeviceType::Cpu => 4,
        };
        adapters.sort_by_key(|adapter| rank(&adapter.get_info()));
        let Some(adapter) = adapters.iter().find(|adapter| choice.admits(&adapter.get_info())) else {
            return Err(no_adapter(choice, &adapters));
        };
        let limits = adapter.limits();
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("umbrage"),
            // Timestamps are a luxury: what measures time can do without.
            required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
            required_limits: wgpu::Limits {
                max_storage_buffer_binding_size: limits.max_storage_buffer_binding_size,
                max_buffer_size: limits.max_buffer_size,
                max_texture_dimension_2d: limits.max_texture_dimension_2d,
                max_storage_buffers_per_shader_stage: limits.max_storage_buffers_per_shader_stage,
                ..wgpu::Limits::downlevel_defaults()
            },
            ..wgpu::DeviceDescriptor::default()
        };
        let info = adapter.get_info();
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).map_err(|error| {
            let message = format!("the adapter `{}` gives no device: {error}", info.name);
            Failure::bare("", Diagnostic::error(codes::DEVICE, message).help("choose another one with `--adapter`"))
        })?;
        let trouble = Arc::new(Mutex::new(None));
        let record = |trouble: &Arc<Mutex<Option<String>>>, message: String| {
            trouble.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(message);
        };
        let errors = trouble.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| record(&errors, error.to_string())));
        let lost = trouble.clone();
        device.set_device_lost_callback(move |reason, message| {
            // Dropping the device is reported here, too, and is no trouble.
            if reason != wgpu::DeviceLostReason::Destroyed {
                record(&lost, format!("the device was lost: {message}"));
            }
        });
        Ok(Self { device, queue, info, trouble })
    }

    /// The adapter's name.
    pub fn name(&self) -> &str {
        &self.info.name
    }

    /// The adapter in words: name, kind, driver.
    pub fn describe(&self) -> String {
        describe(&self.info)
    }

    /// Returns whether the adapter is a software rasteriser.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// The bytes of the largest buffer.
    #[cfg(feature = "render")]
    pub(crate) fn largest_buffer(&self) -> u64 {
        self.device.limits().max_buffer_size
    }

    /// The bytes of the largest storage buffer that a shader can have.
    #[cfg(feature = "render")]
    pub(crate) fn largest_storage(&self) -> u64 {
        let limits = self.device.limits();
        limits.max_buffer_size.min(limits.max_storage_buffer_binding_size)
    }

    /// Waits until everything submitted is done.
    ///
    /// # Errors
    /// With what went wrong on the device meanwhile.
    pub(crate) fn wait(&self) -> Result<(), Failure> {
        let waited = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.check()?;
        waited.map(|_| ()).map_err(|error| {
            let message = format!("the device `{}` does not finish: {error}", self.info.name);
            Failure::bare("", Diagnostic::error(codes::DEVICE, message).help("try another adapter (`--adapter`)"))
        })
    }

    /// Fails with what went wrong on the device, if anything did.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        match self.trouble.lock().unwrap_or_else(PoisonError::into_inner).take() {
            None => Ok(()),
            Some(message) => {
                let headline = format!("the device `{}` failed: {}", self.info.name, message.trim_end());
                let diagnostic = Diagnostic::error(codes::DEVICE, headline)
                    .help("nothing was written; try again, with fewer rows, or on another adapter (`--adapter`)");
                Err(Failure::bare("", diagnostic))
            }
        }
    }
}

fn describe(info: &wgpu::AdapterInfo) -> String {
    let kind = match info.device_type {
        wgpu::DeviceType::DiscreteGpu => "discrete GPU",
        wgpu::DeviceType::IntegratedGpu => "integrated GPU",
        wgpu::DeviceType::VirtualGpu => "virtual GPU",
        wgpu::DeviceType::Cpu => "software",
        wgpu::DeviceType::Other => "device",
    };
    let driver = format!("{} {}", info.driver, info.driver_info);
    format!("{} ({kind}, {:?}, {})", info.name, info.backend, driver.trim())
}

fn no_adapter(choice: &AdapterChoice, adapters: &[wgpu::Adapter]) -> Failure {
    let error = if adapters.is_empty() {
        Diagnostic::error(codes::NO_ADAPTER, "no GPU adapter was found")
            .help("a software one will do; on Debian: apt-get install mesa-vulkan-drivers")
    } else {
        let names: Vec<String> = adapters.iter().map(|adapter| describe(&adapter.get_info())).collect();
        Diagnostic::error(codes::NO_ADAPTER, format!("no adapter suits `{choice}`"))
            .help(format!("there are: {}", names.join("; ")))
            .help("say `any`, `software`, `hardware`, or a part of a name")
    };
    Failure::bare("", error)
}
