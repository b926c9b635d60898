//! The progress of long work.

use indicatif::{ProgressBar, ProgressStyle};

/// A bar of this length, drawn by this template.
pub fn bar(length: u64, template: &str) -> ProgressBar {
    let style = ProgressStyle::with_template(template);
    ProgressBar::new(length).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
