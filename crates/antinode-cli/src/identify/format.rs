//! Parser of `--output`: the format of the rows, with a hint where the name of a file is given instead.

use std::ffi::OsStr;
use std::path::Path;

use clap::builder::{EnumValueParser, PossibleValue, TypedValueParser};
use clap::error::ErrorKind;
use clap::{Arg, Command, Error, ValueEnum};

use crate::options::Format;

/// Reads a format's name.
#[derive(Debug, Clone, Copy)]
pub(super) struct FormatParser;

impl TypedValueParser for FormatParser {
    type Value = Format;

    fn parse_ref(
        &self,
        command: &Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<Format, Error> {
        let parsed = EnumValueParser::<Format>::new().parse_ref(command, argument, value);
        parsed.map_err(|error| match Path::new(value).extension() {
            Some(_) => command.clone().error(
                ErrorKind::InvalidValue,
                format!(
                    "--output is the format, but {0} is a file: give -o {0}",
                    value.display()
                ),
            ),
            None => error,
        })
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let formats = Format::value_variants().iter();
        Some(Box::new(formats.filter_map(Format::to_possible_value)))
    }
}
