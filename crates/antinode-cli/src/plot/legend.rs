//! The legend: recordings by their colours, and the meaning of the marks.

use std::error::Error;

use plotters::coord::Shift;
use plotters::prelude::*;

use super::draw::{ARROW, BEYOND, FLAGGED, TEXT, WIDTH};
use super::figure::Figure;
use crate::canvas::{self, FONT};

/// Colours of a few recordings.
const COLOURS: [RGBColor; 6] = [
    canvas::BLUE,
    canvas::VERMILLION,
    canvas::GREEN,
    canvas::PURPLE,
    canvas::ORANGE,
    canvas::SKY_BLUE,
];
/// Stops between which the colours of more recordings pass, in their order; as these also grow lighter, colour-blind readers can follow
/// (stops of matplotlib's plasma).
const RAMP: [RGBColor; 4] = [
    RGBColor(13, 8, 135),
    RGBColor(126, 3, 168),
    RGBColor(204, 71, 120),
    RGBColor(248, 149, 64),
];
/// Opacity of the bands of a few recordings.
const BAND_OPACITY: f64 = 0.25;
/// Recordings that are named, at most: of more, evenly spaced ones are, with the colours of the others in between.
const MAX_NAMED: usize = 24;
/// Characters of a name that are shown, at most: the last ones, as the end of a path says more than its folder.
const MAX_CHARACTERS: usize = 70;
/// Distance of lines, margin, width of a key before its text, and gap after the text, all in pixels.
const LINE: u32 = 24;
const MARGIN: u32 = 12;
const KEY: u32 = 26;
const GAP: u32 = 26;

/// The mark that an entry explains.
#[derive(Debug, Clone, Copy)]
enum Key {
    Colour(RGBColor),
    Band,
    Flagged,
    Beyond,
}

/// An entry and its place, pixels.
#[derive(Debug)]
struct Entry {
    key: Key,
    text: String,
    x: u32,
    y: u32,
}

/// The legend above all panels.
#[derive(Debug)]
pub struct Legend {
    entries: Vec<Entry>,
    height: u32,
    /// One for each recording.
    colours: Vec<RGBColor>,
}

impl Legend {
    /// The legend that names recordings, and explains the marks that the figure has.
    pub fn new(figure: &Figure, names: &[&str]) -> Result<Self, Box<dyn Error>> {
        let colours = colours(names.len());
        let named = names.len().min(MAX_NAMED);
        let mut texts: Vec<_> = (0..named)
            .map(|place| place * (names.len() - 1) / (named - 1).max(1))
            .map(|index| (Key::Colour(colours[index]), shortened(names[index])))
            .collect();
        if let Some(others @ 1..) = names.len().checked_sub(MAX_NAMED) {
            let text = format!("{others} more, in colours between these");
            texts.push((Key::Colour(canvas::GREY), text));
        }
        let curves = figure.panels.iter().flat_map(|panel| &panel.curves);
        let mut edges = curves.flatten().flat_map(|piece| &piece.band);
        if edges.any(|(_, edges)| edges[0] < edges[1]) {
            texts.push((Key::Band, "± one standard deviation".to_owned()));
        }
        if !figure.flagged.is_empty() {
            texts.push((Key::Flagged, "flagged rows".to_owned()));
        }
        if figure.panels.iter().any(|panel| !panel.beyond.is_empty()) {
            texts.push((Key::Beyond, "values beyond the axis".to_owned()));
        }
        let (mut x, mut y) = (MARGIN, MARGIN);
        let mut entries = Vec::new();
        for (key, text) in texts {
            let (width, _) = (FONT, TEXT).into_font().box_size(&text)?;
            if x > MARGIN && x + KEY + width + MARGIN > WIDTH {
                (x, y) = (MARGIN, y + LINE);
            }
            entries.push(Entry { key, text, x, y });
            x += KEY + width + GAP;
        }
        let height = y + LINE;
        Ok(Self {
            entries,
            height,
            colours,
        })
    }

    /// Height, pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The colour of a recording.
    pub fn colour(&self, index: usize) -> RGBColor {
        self.colours[index]
    }

    /// The opacity of bands: if there are many, which overlap, each is fainter.
    pub fn band_opacity(&self) -> f64 {
        let few = COLOURS.len();
        BAND_OPACITY * few as f64 / self.colours.len().max(few) as f64
    }

    /// Draws the legend, with `units` units a pixel.
    pub fn draw<B: DrawingBackend<ErrorType: 'static>>(
        &self,
        area: &DrawingArea<B, Shift>,
        units: u32,
    ) -> Result<(), Box<dyn Error>> {
        for Entry { key, text, x, y } in &self.entries {
            let at =
                |right: u32, down: u32| ((units * (x + right)) as i32, (units * (y + down)) as i32);
            match key {
                Key::Colour(colour) => {
                    let line = [at(0, 7), at(KEY - 6, 7)];
                    area.draw(&PathElement::new(line, colour.stroke_width(2 * units)))?;
                }
                Key::Band => {
                    let band = [at(0, 2), at(KEY - 6, 12)];
                    area.draw(&Rectangle::new(band, canvas::GREY.mix(0.4).filled()))?;
                }
                Key::Flagged => {
                    let mark = [at(KEY - 10, 3), at(KEY - 8, 11)];
                    area.draw(&Rectangle::new(mark, FLAGGED.filled()))?;
                }
                Key::Beyond => {
                    let (left, middle, right) = (KEY - 8 - ARROW, KEY - 8 - ARROW / 2, KEY - 8);
                    let arrow = [at(left, 4 + ARROW), at(right, 4 + ARROW), at(middle, 4)];
                    area.draw(&Polygon::new(arrow, BEYOND.filled()))?;
                }
            }
            area.draw(&Text::new(text.as_str(), at(KEY, 0), (FONT, units * TEXT)))?;
        }
        Ok(())
    }
}

/// The colours of this many recordings.
fn colours(count: usize) -> Vec<RGBColor> {
    if count <= COLOURS.len() {
        return COLOURS[..count].to_vec();
    }
    let steps = (RAMP.len() - 1) as f64;
    let shares = (0..count).map(|index| index as f64 / (count - 1) as f64);
    shares.map(|share| on_ramp(share * steps)).collect()
}

/// The colour at a place of the ramp, from 0 to the number of its last stop.
fn on_ramp(place: f64) -> RGBColor {
    let stop = (place as usize).min(RAMP.len() - 2);
    let (one, next) = (RAMP[stop], RAMP[stop + 1]);
    let share = place - stop as f64;
    let between = |one: u8, next: u8| {
        (f64::from(one) * (1.0 - share) + f64::from(next) * share).round() as u8
    };
    RGBColor(
        between(one.0, next.0),
        between(one.1, next.1),
        between(one.2, next.2),
    )
}

/// A name short enough to fit, without control characters.
fn shortened(name: &str) -> String {
    let count = name.chars().count();
    let plain = |c: char| if c.is_control() { ' ' } else { c };
    if count <= MAX_CHARACTERS {
        return name.chars().map(plain).collect();
    }
    let end = name.chars().skip(count - MAX_CHARACTERS).map(plain);
    std::iter::once('…').chain(end).collect()
}

#[cfg(test)]
mod tests {
    use super::super::axis::Scale;
    use super::*;

    #[test]
    fn long_names_stay_in_the_picture_side_by_side() {
        let figure = Figure {
            time: Scale::Logarithmic.axis(String::new(), &(1.0..2.0)),
            panels: Vec::new(),
            flagged: Vec::new(),
        };
        let names: Vec<String> = (0..8)
            .map(|k| "a long name ".repeat(4) + &k.to_string())
            .collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        canvas::register_fonts();
        let legend = Legend::new(&figure, &names).unwrap();
        let mut end = (0, MARGIN);
        for Entry { text, x, y, .. } in &legend.entries {
            let (width, _) = (FONT, TEXT).into_font().box_size(text).unwrap();
            assert!(x + KEY + width <= WIDTH, "{x}");
            assert!(*y >= end.1 + LINE || *y == end.1 && *x >= end.0, "{x}, {y}");
            end = (x + KEY + width, *y);
        }
        assert!(end.1 > MARGIN && legend.height() >= end.1 + LINE);
    }

    #[test]
    fn each_recording_has_a_colour_of_its_own() {
        for count in [1, 6, 7, 20, 100] {
            let mut colours: Vec<_> = colours(count).iter().map(|c| (c.0, c.1, c.2)).collect();
            colours.sort_unstable();
            colours.dedup();
            assert_eq!(colours.len(), count);
        }
        let of_many = colours(7);
        assert_eq!(
            [of_many[0], of_many[2], of_many[6]],
            [RAMP[0], RAMP[1], RAMP[3]]
        );
    }
}
