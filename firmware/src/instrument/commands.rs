//! Execution and acknowledgement of commands.

use antinode::{Front, Sample};
use antinode_telemetry::{Acknowledgement, Command, CommandError, CommandFrame, Report};

use super::Instrument;
use crate::gather::Request;
use crate::methods::AVAILABLE;
use crate::settings::{LONGEST_PERIOD, RING};

impl<S: Sample> Instrument<'_, S> {
    /// Executes a command and acknowledges it; true if it succeeded.
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

    // Not inlined, as it is rare: the main loop's frame stays small.
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
            Command::SetWindow { .. } | Command::SetHop { .. } | Command::SetFrequency { .. } => {
                self.change(command, true)?;
            }
            Command::SetCalibration(_) | Command::SetHum { .. } | Command::SetColoured { .. } => {
                self.change(command, false)?;
            }
        }
        Ok(())
    }

    /// Changes settings; blocks that wait need not be discarded unless the command changes blocks.
    fn change(&mut self, command: &Command, changes_blocks: bool) -> Result<(), CommandError> {
        let configuration = self.configuration.after(command, RING)?;
        Front::<S, LONGEST_PERIOD>::check(&configuration.settings)?;
        if changes_blocks {
            // Sent first, as there may be no room: the interrupt's blocks keep the old number until `poll` stores the new one.
            self.ask(Request::Configure(configuration.settings))?;
            // Discards the blocks that wait: they were gathered with the old settings.
            self.tracker.search();
        }
        self.tracker.change(configuration.settings)?;
        self.configuration = configuration;
        self.hello();
        Ok(())
    }
}
