//! The window: events in, frames out.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use umbrage::scene::Scene;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop, OwnedDisplayHandle};
use winit::keyboard::{Key, NamedKey};
use winit::window::{Window, WindowId};

use crate::feedback::Feedback;
use crate::gpu::Gpu;
use crate::panel;
use crate::renderer::{Renderer, take_tables};
use crate::shaders::{PLANS, Watch};
use crate::view::{TECHNIQUES, View};

/// How often the files of tables are looked at.
const LOOK: Duration = Duration::from_millis(200);

/// Shows a scene until the window is closed.
pub(crate) fn show(scene: &Scene, texels: u32, table: Option<&Path>, view: View, size: [u32; 2]) -> Result<(), String> {
    let no_window = |error: &dyn std::fmt::Display| {
        format!("error: there is no window: {error}\n  help: without a display, write a picture: --headless out.png")
    };
    let events = EventLoop::new().map_err(|error| no_window(&error))?;
    let mut program = Program {
        display: events.owned_display_handle(),
        scene,
        texels,
        table,
        first: view,
        view,
        size,
        watch: Watch::new(table),
        looked: Instant::now(),
        shown: None,
        ended: Ok(()),
    };
    events.run_app(&mut program).map_err(|error| no_window(&error))?;
    program.ended
}

struct Program<'a> {
    display: OwnedDisplayHandle,
    scene: &'a Scene,
    texels: u32,
    /// A table to begin with, instead of the one compiled in.
    table: Option<&'a Path>,
    /// The view at the beginning, and the one now.
    first: View,
    view: View,
    /// The size of a new window.
    size: [u32; 2],
    watch: Watch,
    looked: Instant,
    shown: Option<Shown>,
    /// Why the program ended.
    ended: Result<(), String>,
}

/// A window and what is in it.
struct Shown {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    renderer: Renderer,
    input: egui_winit::State,
    painter: egui_wgpu::Renderer,
    feedback: Option<Feedback>,
    /// Why a table that was changed is not the one that is shown.
    problem: Option<String>,
    last_frame: Instant,
    /// From frame to frame, smoothed.
    frame_time: Duration,
    cursor: [f64; 2],
    dragging: bool,
    turning: bool,
}

impl ApplicationHandler for Program<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.shown.is_none() {
            match self.open(events) {
                Ok(shown) => self.shown = Some(shown),
                Err(problem) => self.end(events, problem),
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(shown) = &mut self.shown else { return };
        let response = shown.input.on_window_event(&shown.window, &event);
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(size) => shown.resize([size.width, size.height]),
            WindowEvent::RedrawRequested => {
                if let Err(problem) = shown.draw(&mut self.view) {
                    self.end(events, problem);
                }
            }
            WindowEvent::KeyboardInput { event, .. } if event.state == ElementState::Pressed => {
                self.key(events, &event.logical_key);
            }
            WindowEvent::MouseInput { state, button: MouseButton::Left, .. } => {
                shown.dragging = state == ElementState::Pressed && !response.consumed;
            }
            WindowEvent::CursorMoved { position, .. } => {
                let [x, y] = std::mem::replace(&mut shown.cursor, [position.x, position.y]);
                if shown.dragging {
                    self.view.turn(-0.005 * (position.x - x), 0.005 * (position.y - y));
                }
            }
            WindowEvent::MouseWheel { delta, .. } if !response.consumed => {
                let lines = match delta {
                    MouseScrollDelta::LineDelta(_, y) => f64::from(y),
                    MouseScrollDelta::PixelDelta(pixels) => pixels.y / 40.0,
                };
                self.view.zoom(0.9_f64.powf(lines));
            }
            _ => {}
        }
    }

    fn about_to_wait(&mut self, _: &ActiveEventLoop) {
        let Some(shown) = &mut self.shown else { return };
        if self.looked.elapsed() > LOOK {
            self.looked = Instant::now();
            let changed = self.watch.changed();
            if !changed.is_empty() {
                shown.problem = take_tables(&mut shown.renderer, &changed, &self.view).err();
            }
        }
        if let Some(feedback) = shown.renderer.collector.take(&shown.renderer.gpu, wgpu::PollType::Poll) {
            shown.feedback = Some(feedback);
        }
        if shown.turning {
            self.view.turn(0.4 * shown.frame_time.as_secs_f64().min(0.1), 0.0);
        }
        // One frame after the other, as fast as the display takes them: their time is what is to be seen.
        shown.window.request_redraw();
    }
}

impl Program<'_> {
    fn end(&mut self, events: &ActiveEventLoop, problem: String) {
        self.ended = Err(problem);
        events.exit();
    }

    fn open(&self, events: &ActiveEventLoop) -> Result<Shown, String> {
        let [width, height] = self.size;
        let attributes = Window::default_attributes()
            .with_title("Umbrage: shadows")
            .with_inner_size(winit::dpi::PhysicalSize::new(width, height));
        let window = events.create_window(attributes).map_err(|error| format!("error: no window: {error}"))?;
        let window = Arc::new(window);
        let display = Box::new(self.display.clone());
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_with_display_handle(display));
        let surface = instance.create_surface(window.clone()).map_err(|error| format!("error: {error}"))?;
        let gpu = Gpu::open(&instance, Some(&surface))?;
        let size = window.inner_size();
        let mut config = surface
            .get_default_config(&gpu.adapter, size.width.max(1), size.height.max(1))
            .ok_or_else(|| format!("error: {} cannot draw into this window", gpu.name()))?;
        // Light is computed linearly; a format that says so encodes it.
        let formats = surface.get_capabilities(&gpu.adapter).formats;
        config.format = formats.iter().copied().find(wgpu::TextureFormat::is_srgb).unwrap_or(config.format);
        surface.configure(&gpu.device, &config);
        let format = config.format;
        let painter = egui_wgpu::Renderer::new(&gpu.device, format, egui_wgpu::RendererOptions::default());
        let side = gpu.device.limits().max_texture_dimension_2d as usize;
        let context = egui::Context::default();
        let root = egui::ViewportId::ROOT;
        let input = egui_winit::State::new(context, root, &window, None, window.theme(), Some(side));
        let mut renderer = Renderer::new(gpu, self.scene, self.texels, format)?;
        let problem = self.table.and_then(|table| renderer.take_table(table, &self.view).err());
        Ok(Shown {
            window,
            surface,
            config,
            renderer,
            input,
            painter,
            feedback: None,
            problem,
            last_frame: Instant::now(),
            frame_time: Duration::ZERO,
            cursor: [0.0; 2],
            dragging: false,
            turning: false,
        })
    }

    fn key(&mut self, events: &ActiveEventLoop, key: &Key) {
        let view = &mut self.view;
        match key {
            Key::Named(NamedKey::Escape) => events.exit(),
            Key::Named(NamedKey::ArrowLeft) => view.turn(-0.1, 0.0),
            Key::Named(NamedKey::ArrowRight) => view.turn(0.1, 0.0),
            Key::Named(NamedKey::ArrowUp) => view.turn(0.0, 0.1),
            Key::Named(NamedKey::ArrowDown) => view.turn(0.0, -0.1),
            Key::Named(NamedKey::Space) => {
                if let Some(shown) = &mut self.shown {
                    shown.turning = !shown.turning;
                }
            }
            Key::Character(text) => match text.to_lowercase().as_str() {
                "p" => view.plan = (view.plan + 1) % PLANS.len(),
                "c" => view.cases = !view.cases,
                "r" => view.go_to(&self.first),
                "+" | "=" => view.zoom(0.9),
                "-" => view.zoom(1.0 / 0.9),
                digit => {
                    let index = digit.parse::<usize>().ok().and_then(|digit| digit.checked_sub(1));
                    if let Some(technique) = index.and_then(|index| TECHNIQUES.get(index)) {
                        view.technique = *technique;
                    }
                }
            },
            _ => {}
        }
    }
}

impl Shown {
    fn resize(&mut self, [width, height]: [u32; 2]) {
        // A window that is minimised has no pixels.
        if width > 0 && height > 0 {
            (self.config.width, self.config.height) = (width, height);
            self.surface.configure(&self.renderer.gpu.device, &self.config);
        }
    }

    fn draw(&mut self, view: &mut View) -> Result<(), String> {
        use wgpu::CurrentSurfaceTexture::{Lost, Occluded, Outdated, Suboptimal, Success, Timeout, Validation};
        let target = match self.surface.get_current_texture() {
            Success(target) | Suboptimal(target) => target,
            Outdated => {
                self.surface.configure(&self.renderer.gpu.device, &self.config);
                return Ok(());
            }
            Timeout | Occluded => return Ok(()),
            Lost | Validation => return Err("error: the window's surface was lost".to_owned()),
        };
        let now = Instant::now();
        let passed = now - std::mem::replace(&mut self.last_frame, now);
        self.frame_time = if self.frame_time.is_zero() { passed } else { (self.frame_time * 7 + passed) / 8 };

        let output = target.texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.renderer.resize([target.texture.width(), target.texture.height()]);
        self.renderer.render(view, &output)?;
        self.draw_panel(view, &output, [target.texture.width(), target.texture.height()]);
        self.window.set_title(&panel::title(view, &self.renderer, self.feedback.as_ref()));
        self.window.pre_present_notify();
        self.renderer.gpu.queue.present(target);
        Ok(())
    }

    /// Draws the panel over the picture.
    fn draw_panel(&mut self, view: &mut View, output: &wgpu::TextureView, size_in_pixels: [u32; 2]) {
        let context = self.input.egui_ctx().clone();
        let raw = self.input.take_egui_input(&self.window);
        let mut drawn = context.run_ui(raw, |ui| {
            let (renderer, feedback, problem) = (&self.renderer, self.feedback.as_ref(), self.problem.as_deref());
            panel::show(ui, view, renderer, feedback, self.frame_time, problem);
        });
        self.input.handle_platform_output(&self.window, drawn.platform_output);
        let gpu = &self.renderer.gpu;
        for (id, deltas) in std::mem::take(&mut drawn.textures_delta.set) {
            for delta in &deltas {
                self.painter.update_texture(&gpu.device, &gpu.queue, id, delta);
            }
        }
        let screen = egui_wgpu::ScreenDescriptor { size_in_pixels, pixels_per_point: drawn.pixels_per_point };
        let triangles = context.tessellate(drawn.shapes, drawn.pixels_per_point);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let commands = self.painter.update_buffers(&gpu.device, &gpu.queue, &mut encoder, &triangles, &screen);
        let ops = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
        let over = wgpu::RenderPassColorAttachment { view: output, depth_slice: None, resolve_target: None, ops };
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("panel"),
            color_attachments: &[Some(over)],
            ..Default::default()
        });
        self.painter.render(&mut pass.forget_lifetime(), &triangles, &screen);
        gpu.queue.submit(commands.into_iter().chain([encoder.finish()]));
        for id in std::mem::take(&mut drawn.textures_delta.free) {
            self.painter.free_texture(&id);
        }
    }
}
