//! The game in a window: tiles are built in the background while the camera turns.

use crate::common::{Failure, view};
use crate::{Game, SIZE_PX};
use std::sync::Arc;
use tellus::lod::Quality;
use tellus::render::{Renderer, wgpu};
use tellus::tiles::Builder;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::keyboard::{Key, NamedKey};
use winit::window::{Window, WindowId};

/// Turn of one key press.
const TURN_RAD: f64 = 0.05;

/// Opens the window and plays until it is closed.
pub(crate) fn run() -> Result<(), Failure> {
    let mut app = App { playing: None, failure: None };
    EventLoop::new()?.run_app(&mut app)?;
    app.failure.map_or(Ok(()), Err)
}

struct App {
    playing: Option<Playing>,
    failure: Option<Failure>,
}

struct Playing {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    device: wgpu::Device,
    queue: wgpu::Queue,
    renderer: Renderer,
    builder: Builder,
    game: Game,
}

impl Playing {
    fn new(event_loop: &ActiveEventLoop) -> Result<Self, Failure> {
        let size = PhysicalSize::new(SIZE_PX[0], SIZE_PX[1]);
        let attributes = Window::default_attributes().with_title("A game on a planet").with_inner_size(size);
        let window = Arc::new(event_loop.create_window(attributes)?);
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle().with_env());
        let surface = instance.create_surface(Arc::clone(&window))?;
        let options = wgpu::RequestAdapterOptions {
            compatible_surface: Some(&surface),
            ..wgpu::RequestAdapterOptions::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options))?;
        let required_limits = Renderer::required_limits();
        let descriptor = wgpu::DeviceDescriptor { required_limits, ..wgpu::DeviceDescriptor::default() };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))?;
        let size = window.inner_size();
        let config = surface
            .get_default_config(&adapter, size.width.max(1), size.height.max(1))
            .ok_or("the window cannot be drawn into with this adapter")?;
        surface.configure(&device, &config);
        let renderer = Renderer::new(&device, &queue)?;
        let game = Game::new(&device, &renderer)?;
        let waking = Arc::clone(&window);
        let builder = Builder::new(move || waking.request_redraw());
        Ok(Self { window, surface, config, device, queue, renderer, builder, game })
    }

    fn resize(&mut self, size: PhysicalSize<u32>) {
        (self.config.width, self.config.height) = (size.width.max(1), size.height.max(1));
        self.surface.configure(&self.device, &self.config);
    }

    fn draw(&mut self) -> Result<(), Failure> {
        let camera_view = self.game.view([self.config.width, self.config.height], Quality::Low);
        self.builder.request(&self.game.planet, &camera_view)?;
        let Some(tiles) = self.builder.surface() else { return Ok(()) };
        let wgpu::CurrentSurfaceTexture::Success(frame) = self.surface.get_current_texture() else {
            self.surface.configure(&self.device, &self.config);
            self.window.request_redraw();
            return Ok(());
        };
        let device = (&self.device, &self.queue);
        self.game.draw(device, &mut self.renderer, &tiles, camera_view, &view(&frame.texture))?;
        self.queue.present(frame);
        Ok(())
    }
}

impl ApplicationHandler for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        match Playing::new(event_loop) {
            Ok(playing) => self.playing = Some(playing),
            Err(failure) => {
                self.failure = Some(failure);
                event_loop.exit();
            }
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(playing) = &mut self.playing else { return };
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::Resized(size) => playing.resize(size),
            WindowEvent::KeyboardInput { event, .. } if event.state == ElementState::Pressed => {
                match event.logical_key {
                    Key::Named(NamedKey::ArrowLeft) => playing.game.heading_rad -= TURN_RAD,
                    Key::Named(NamedKey::ArrowRight) => playing.game.heading_rad += TURN_RAD,
                    Key::Named(NamedKey::Escape) => event_loop.exit(),
                    _ => {}
                }
                playing.window.request_redraw();
            }
            WindowEvent::RedrawRequested => {
                if let Err(failure) = playing.draw() {
                    self.failure = Some(failure);
                    event_loop.exit();
                }
            }
            _ => {}
        }
    }
}
