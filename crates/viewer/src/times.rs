//! The times of the last frames, as a graph.

use std::collections::VecDeque;

use egui::{Color32, Sense, Stroke, Ui, pos2, vec2};

/// The frames that are shown.
const FRAMES: usize = 180;

/// The times of the last frames in milliseconds.
#[derive(Default)]
pub(crate) struct Times {
    each: VecDeque<f32>,
}

impl Times {
    pub(crate) fn push(&mut self, milliseconds: f32) {
        if self.each.len() == FRAMES {
            self.each.pop_front();
        }
        self.each.push_back(milliseconds);
    }

    fn median(&self) -> f32 {
        let mut sorted: Vec<f32> = self.each.iter().copied().collect();
        sorted.sort_unstable_by(f32::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
    }

    /// A bar a frame, under a line at a sixtieth of a second.
    pub(crate) fn show(&self, ui: &mut Ui) {
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 44.0), Sense::hover());
        let most = self.each.iter().copied().fold(1000.0 / 60.0, f32::max);
        let width = rect.width() / FRAMES as f32;
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 2.0, Color32::from_black_alpha(120));
        for (number, time) in self.each.iter().enumerate() {
            let x = rect.left() + width * (number as f32 + 0.5);
            let top = rect.bottom() - rect.height() * time / most;
            let line = [pos2(x, rect.bottom()), pos2(x, top)];
            painter.line_segment(line, Stroke::new(width, Color32::from_rgb(110, 170, 240)));
        }
        let y = rect.bottom() - rect.height() * (1000.0 / 60.0) / most;
        painter.hline(rect.x_range(), y, Stroke::new(1.0, Color32::from_white_alpha(90)));
        let worst = self.each.iter().copied().fold(0.0, f32::max);
        response.on_hover_text(format!(
            "The last {} frames: {:.2} ms in the middle, {worst:.2} ms at most. The line is a sixtieth of a second.",
            self.each.len(),
            self.median()
        ));
    }
}
