//! What is written over the picture, and what is printed without a window.

use std::time::Duration;

use egui::{Align2, Color32, RichText};

use crate::feedback::{CASES, Feedback};
use crate::renderer::{Renderer, case_colour};
use crate::shaders::PLANS;
use crate::view::{TECHNIQUES, View};

/// What keys do.
pub(crate) const KEYS: &str = "\
Keys in the window:
  1 to 5        technique: hard, pcf, smsr, rsmss, rpcf
  P             the next plan of the table
  C             cases in colours
  drag, arrows  around the scene
  wheel, +, -   closer, away
  space         turn by itself
  R             back to the beginning
  escape        quit";

/// A case, as the legend shows it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Entry {
    /// Its place in the palette.
    pub(crate) index: usize,
    pub(crate) pixels: u32,
    pub(crate) name: String,
}

impl std::fmt::Display for Entry {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.index + 1 < CASES {
            true => write!(f, "case {:>3}  {:>8} px  {}", self.index, self.pixels, self.name),
            false => write!(f, "default   {:>8} px", self.pixels),
        }
    }
}

/// The cases that pixels took, the most frequent first.
pub(crate) fn legend(view: &View, renderer: &Renderer, counts: &[u32]) -> Vec<Entry> {
    let Some(table) = renderer.tables.of(view.technique) else { return Vec::new() };
    let name = |index: usize| table.cases.get(&(index as u32)).cloned().unwrap_or_default();
    let taken = counts.iter().enumerate().filter(|(_, pixels)| **pixels > 0);
    let mut entries: Vec<Entry> =
        taken.map(|(index, pixels)| Entry { index, pixels: *pixels, name: name(index) }).collect();
    entries.sort_by_key(|entry| std::cmp::Reverse(entry.pixels));
    entries
}

/// What is seen, and what it took.
pub(crate) fn title(view: &View, renderer: &Renderer, feedback: Option<&Feedback>) -> String {
    let plan = PLANS[renderer.tables.suitable(view.technique, view.plan)].name();
    let plan = match renderer.tables.of(view.technique) {
        Some(table) if table.reloaded => format!(", plan {plan}, table read again"),
        Some(_) => format!(", plan {plan}"),
        None => String::new(),
    };
    let times = match feedback.and_then(|feedback| feedback.times) {
        Some([camera, light]) => format!(": {} for the camera, {} for shadows and light", ms(camera), ms(light)),
        None => String::new(),
    };
    format!("{}{plan}{times}, on {}", view.technique, renderer.gpu.name())
}

fn ms(time: Duration) -> String {
    format!("{:.2} ms", 1e3 * time.as_secs_f64())
}

/// Draws what stands over the picture, and takes what is chosen there.
pub(crate) fn show(
    ui: &mut egui::Ui,
    view: &mut View,
    renderer: &Renderer,
    feedback: Option<&Feedback>,
    frame_time: Duration,
    problem: Option<&str>,
) {
    let context = ui.ctx().clone();
    egui::Window::new("Shadows").anchor(Align2::LEFT_TOP, [8.0, 8.0]).resizable(false).show(&context, |ui| {
        ui.horizontal(|ui| {
            for technique in TECHNIQUES {
                ui.selectable_value(&mut view.technique, technique, technique.name());
            }
        });
        let table = renderer.tables.of(view.technique);
        ui.add_enabled_ui(table.is_some(), |ui| {
            ui.horizontal(|ui| {
                let now = renderer.tables.suitable(view.technique, view.plan);
                for (index, plan) in PLANS.iter().enumerate() {
                    let label = egui::Button::selectable(index == now, plan.name());
                    if ui.add_enabled(table.is_some_and(|table| table.suits(index)), label).clicked() {
                        view.plan = index;
                    }
                }
            });
            ui.checkbox(&mut view.cases, "cases in colours");
        });
        ui.separator();
        ui.label(format!("frame {}", ms(frame_time)));
        match feedback.and_then(|feedback| feedback.times) {
            Some([camera, light]) => {
                ui.label(format!("camera {}, shadows and light {}", ms(camera), ms(light)));
            }
            None => {
                ui.label("this device has no clock of its own");
            }
        }
        if table.is_some_and(|table| table.reloaded) {
            ui.label("the table has been read again");
        }
        ui.label(RichText::new(renderer.gpu.name()).weak());
        ui.collapsing("keys", |ui| ui.monospace(KEYS));
    });
    if view.cases
        && let Some(feedback) = feedback
    {
        cases(&context, &legend(view, renderer, &feedback.counts));
    }
    if let Some(problem) = problem {
        let frame = egui::Frame::new().fill(Color32::from_rgb(70, 8, 8)).inner_margin(8.0);
        let window = egui::Window::new("The table is wrong; the last good one is shown").frame(frame);
        let window = window.min_width(440.0).anchor(Align2::LEFT_BOTTOM, [8.0, -8.0]).resizable(false).vscroll(true);
        window.max_height(0.5 * context.content_rect().height()).show(&context, |ui| {
            let text = RichText::new(problem).monospace().color(Color32::WHITE);
            ui.add(egui::Label::new(text).extend());
        });
    }
}

/// The legend.
fn cases(context: &egui::Context, entries: &[Entry]) {
    let window = egui::Window::new("Cases").anchor(Align2::RIGHT_TOP, [-8.0, 8.0]).resizable(false).vscroll(true);
    window.show(context, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        ui.spacing_mut().interact_size.y = 12.0;
        if entries.is_empty() {
            ui.label("no pixel asks the table");
        }
        for entry in entries {
            ui.horizontal(|ui| {
                let [r, g, b] = case_colour(entry.index);
                let (place, _) = ui.allocate_exact_size(egui::vec2(12.0, 12.0), egui::Sense::hover());
                ui.painter().rect_filled(place, 2.0, Color32::from_rgb(r, g, b));
                ui.label(RichText::new(entry.to_string()).monospace().size(11.0));
            });
        }
    });
}
