//! The font and the colours of all figures.

use std::io;
use std::sync::Once;

use plotters::style::{FontStyle, RGBColor, register_font};

/// The font's name; a viewer of an SVG that lacks the font uses its own sans-serif one.
pub const FONT: &str = "sans-serif";

/// Colours that colour-blind readers can distinguish too (Okabe and Ito's).
pub const ORANGE: RGBColor = RGBColor(230, 159, 0);
pub const SKY_BLUE: RGBColor = RGBColor(86, 180, 233);
pub const GREEN: RGBColor = RGBColor(0, 158, 115);
pub const VERMILLION: RGBColor = RGBColor(213, 94, 0);
pub const BLUE: RGBColor = RGBColor(0, 114, 178);
pub const PURPLE: RGBColor = RGBColor(204, 121, 167);
/// For what is of less importance.
pub const GREY: RGBColor = RGBColor(150, 150, 150);
/// Lines of the grid.
pub const GRID: RGBColor = RGBColor(215, 215, 215);

/// The error for an image that cannot be stored: the encoder's own wraps the system's message in names of its types.
pub fn not_stored() -> io::Error {
    io::Error::other("the image is not stored whole")
}

/// Registers the font; to be called before anything is drawn or measured.
pub fn register_fonts() {
    static FONTS: Once = Once::new();
    FONTS.call_once(|| {
        // It fails only for an unreadable font.
        let _ = register_font(FONT, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT);
    });
}
