//! Commands are obeyed and acknowledged.

use antinode::Sample;
use antinode_telemetry::{Acknowledgement, Command, CommandError, CommandFrame, Report};

use super::Instrument;
use crate::gather::Request;
use crate::methods::AVAILABLE;
use crate::settings::RING;

impl<S: Sample> Instrument<'_, S> {
    /// Obeys a command and acknowledges it; true where it was done.
    pub(super) fn answer(&mut self, CommandFrame { id, command }: CommandFrame) -> bool {
        let result = self.obey(&command);
        let acknowledgement = Acknowledgement { id, result };
        self.link.send(&Report::Acknowledgement(acknowledgement));
        if self.restart.is_some() {
            self.link.close();
        }
        self.answered = self.answered.wrapping_add(1);
        result.is_ok()
    }

    // Rare: the main loop's stack need not hold what it needs.
    #[cold]
    #[inline(never)]
    fn obey(&mut self, command: &Command) -> Result<(), CommandError> {
        match command {
            Command::Get => self.hello(),
            Command::Restart => self.restart = Some(self.now),
            Command::SetMethods { on } => {
                if *on && !AVAILABLE {
                    return Err(CommandError::Unsupported);
                }
                let configuration = self.configuration.after(command, RING)?;
                self.ask(Request::Tune(None))?;
                self.tuning = None;
                self.configuration = configuration;
                self.hello();
            }
            Command::SetWindow { .. } | Command::SetHop { .. } | Command::SetCalibration(_) => {
                let configuration = self.configuration.after(command, RING)?;
                // Blocks are as they were, but for their calibration.
                let is_new = !matches!(command, Command::SetCalibration(_));
                if is_new {
                    self.ask(Request::Configure(configuration.settings))?;
                    // What waits was gathered with the settings before.
                    self.tracker.search();
                }
                self.tracker.change(configuration.settings)?;
                self.configuration = configuration;
                self.hello();
            }
        }
        Ok(())
    }
}
