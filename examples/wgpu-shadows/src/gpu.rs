//! The device.

/// An adapter and its device.
pub(crate) struct Gpu {
    pub(crate) adapter: wgpu::Adapter,
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
}

impl Gpu {
    /// Opens the adapter that the environment names, or the fastest one, for a surface if there is one.
    pub(crate) fn open(instance: &wgpu::Instance, surface: Option<&wgpu::Surface<'_>>) -> Result<Self, String> {
        let adapter = pollster::block_on(wgpu::util::initialize_adapter_from_env_or_default(instance, surface));
        let adapter = adapter.map_err(|error| {
            format!(
                "error: there is no graphics adapter: {error}\n  \
                 help: install a driver for Vulkan, Metal or DirectX 12; on Debian the software driver is in the \
                 package mesa-vulkan-drivers"
            )
        })?;
        let device = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: None,
            required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
            required_limits: wgpu::Limits::default().using_resolution(adapter.limits()),
            ..Default::default()
        }));
        let name = adapter.get_info().name;
        let (device, queue) = device.map_err(|error| format!("error: {name} cannot be used: {error}"))?;
        Ok(Self { adapter, device, queue })
    }

    /// The name of the adapter.
    pub(crate) fn name(&self) -> String {
        self.adapter.get_info().name
    }

    /// What goes wrong with the device while `make` runs.
    pub(crate) fn guarded<T>(&self, make: impl FnOnce() -> T) -> Result<T, String> {
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let made = make();
        match pollster::block_on(scope.pop()) {
            None => Ok(made),
            Some(error) => Err(error.to_string()),
        }
    }
}
