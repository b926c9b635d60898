//! The paper's four methods beside every estimate.

use antinode_telemetry::{Command, Methods, Report};

use crate::emulator::{Device, bytes};
use crate::told::estimates;
use crate::{mirror, recordings};

fn methods(reports: &[Report]) -> Vec<Methods> {
    let found = |report: &Report| match report {
        Report::Methods(methods) => Some(*methods),
        _ => None,
    };
    reports.iter().filter_map(found).collect()
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn methods_come_with_their_windows() {
    for (name, recording) in recordings::all().into_iter().take(4) {
        let command = bytes(3, Command::SetMethods { on: true });
        let mut device = Device::start("replay", &recording, "hold=1");
        device.send(&command);
        let (reports, lost, took) = device.finish();
        assert_eq!(lost, 0, "{name}");
        let (windows, methods) = (estimates(&reports), methods(&reports));
        println!(
            "{name}: {} windows, {} methods, {} disagree, {took:.1} s",
            windows.len(),
            methods.len(),
            methods.iter().filter(|m| m.disagree).count()
        );
        // All windows except those before the sums were tuned to the wave.
        assert!(
            methods.len() + 60 > windows.len(),
            "{name}: {} of {}",
            methods.len(),
            windows.len()
        );
        assert!(!methods.iter().any(|m| m.disagree), "{name}");
        for m in &methods {
            let e = windows
                .iter()
                .find(|e| e.start == m.start)
                .expect("its window");
            // Algorithms 2 and 4 include quadrature, and a window that does not fit the period costs them only leakage.
            let size = f64::from(e.main_amplitude);
            for method in [&m.methods[1], &m.methods[3]] {
                assert!(
                    (method.main_amplitude - size).abs()
                        < 0.02 * size + 8.0 * f64::from(e.main_amplitude_std),
                    "{name}: {m:?}, {e:?}"
                );
                assert!(
                    (method.angle - e.angle).abs() < 0.02 + 8.0 * f64::from(e.angle_std),
                    "{name}: {m:?}, {e:?}"
                );
            }
            let mut ranks = m.methods.map(|method| method.rank);
            ranks.sort_unstable();
            assert_eq!(ranks, [1, 2, 3, 4], "{name}");
        }
        let host = mirror::reports::<i16>(&recording, &command, 1);
        assert!(
            methods == self::methods(&host),
            "{name}: the emulator and the host differ"
        );
    }
}

#[test]
fn the_first_window_after_a_tuning_is_compared_once_its_sums_are_complete() {
    let recording = recordings::codes(recordings::WAVE, recordings::quiet(), 50_000);
    // A window begins with every block: the first one with sums in all its blocks counts too.
    let mut commands = bytes(1, Command::SetHop { blocks: Some(1) });
    commands.extend(bytes(2, Command::SetMethods { on: true }));
    let methods = methods(&mirror::reports::<i16>(&recording, &commands, 1));
    assert!(methods.len() > 1000, "{}", methods.len());
    let disagree = methods.iter().filter(|m| m.disagree).count();
    assert_eq!(disagree, 0, "of {}", methods.len());
}

#[test]
#[ignore = "needs the ARM target and QEMU"]
fn methods_are_off_by_default_and_can_be_switched_off_again() {
    let recording = recordings::codes(recordings::WAVE, recordings::quiet(), 50_000);
    let mut device = Device::start("replay", &recording, "hold=2");
    device.command(1, Command::SetMethods { on: true });
    device.command(2, Command::SetMethods { on: false });
    let (reports, ..) = device.finish();
    assert!(methods(&reports).is_empty() && estimates(&reports).len() > 200);
}
