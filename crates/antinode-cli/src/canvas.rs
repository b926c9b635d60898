//! What all figures are drawn with: a font of their own, and colours.

use std::io;
use std::sync::Once;

use plotters::style::{FontStyle, RGBColor, register_font};

/// The font's name; viewers of an SVG that have no such font take their own sans.
pub const FONT: &str = "sans-serif";

/// Colours that are told apart by colour-blind readers too (Okabe and Ito's).
pub const ORANGE: RGBColor = RGBColor(230, 159, 0);
pub const SKY_BLUE: RGBColor = RGBColor(86, 180, 233);
pub const GREEN: RGBColor = RGBColor(0, 158, 115);
pub const VERMILLION: RGBColor = RGBColor(213, 94, 0);
pub const BLUE: RGBColor = RGBColor(0, 114, 178);
pub const PURPLE: RGBColor = RGBColor(204, 121, 167);
/// For what stands back.
pub const GREY: RGBColor = RGBColor(150, 150, 150);
/// Lines of the grid.
pub const GRID: RGBColor = RGBColor(215, 215, 215);

/// What is told where an image cannot be stored: the encoder gives the system's words among names of its own.
pub fn not_stored() -> io::Error {
    io::Error::other("the image is not stored whole")
}

/// Makes the font known; to be called before anything is drawn or measured.
pub fn register_fonts() {
    static FONTS: Once = Once::new();
    FONTS.call_once(|| {
        // It fails only for a font that cannot be read, and this one can.
        let _ = register_font(FONT, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT);
    });
}
