//! A device's reports in words.

use antinode::Detection;
use antinode_telemetry::{Configuration, Counters, FrontEnd, Hello, Methods};

use crate::digits::{counted, significant};
use crate::methods::table::DISAGREE;

/// The device's version and configuration in one line.
pub fn hello(hello: &Hello) -> String {
    let Configuration {
        settings: s,
        front_end,
        methods,
    } = &hello.configuration;
    let c = &s.calibration;
    let hop = match s.hop {
        None => "no hop".to_owned(),
        Some(blocks) => format!("hop {}", counted(blocks.into(), "block")),
    };
    let level = |name, value: Option<f32>| value.map_or(String::new(), |x| format!(", {name} {x}"));
    format!(
        "firmware {}, protocol {}, {}, {} Hz, window {} periods, {hop}, methods {}, gain ratio {}, skew {} ns, \
         pick-off angle {} rad, start angle {} rad{}{}{}{}{}{}{}",
        hello.firmware,
        hello.protocol,
        source(*front_end),
        s.sample_rate,
        s.periods,
        if *methods { "on" } else { "off" },
        c.gain_ratio,
        nanoseconds(c.skew),
        c.pick_off_angle,
        s.start_angle,
        s.rails.map_or(String::new(), |[low, high]| format!(
            ", rails {low} and {high}"
        )),
        level("resolution", s.resolution),
        s.frequency
            .map_or(String::new(), |hertz| format!(", frequency {hertz} Hz")),
        match s.detection {
            Detection::MeanReturn => ", detector mean-return",
            _ => "",
        },
        if s.watch { "" } else { ", samples not watched" },
        if s.hum { ", hum" } else { "" },
        if s.coloured { ", coloured noise" } else { "" },
    )
}

/// A skew in ns, rounded to the digits that single precision keeps of any number, so that it reads as it was typed.
pub fn nanoseconds(skew: f32) -> f64 {
    significant(f64::from(skew) * 1e9, f32::DIGITS as usize)
}

fn source(front_end: FrontEnd) -> &'static str {
    match front_end {
        FrontEnd::DualAdc => "dual ADC",
        FrontEnd::SequencedAdc => "ADC in sequence",
        FrontEnd::Spi => "external converter on SPI",
        FrontEnd::Sai => "external converter on SAI",
        FrontEnd::Dfsdm => "DFSDM",
        FrontEnd::Synthetic => "synthetic wave",
        _ => "unknown front end",
    }
}

/// The counters in one line; those of faults only if they are not 0.
pub fn counters(c: &Counters) -> String {
    let mut line = format!(
        "up {:.1} s, {} sample pairs",
        c.uptime_ms as f64 * 1e-3,
        c.pairs
    );
    let troubles = [
        (c.pairs_lost, "pairs lost"),
        (c.saturated_pairs, "saturated pairs"),
        (c.saturated_blocks.into(), "saturated blocks"),
        (c.overruns.into(), "ADC overruns"),
        (c.blocks_dropped.into(), "blocks dropped"),
        (c.reports_dropped.into(), "reports dropped"),
        (c.commands_damaged.into(), "commands damaged"),
        (c.restarts.into(), "restarts"),
    ];
    for (count, name) in troubles.into_iter().filter(|(count, _)| *count > 0) {
        line += &format!(", {count} {name}");
    }
    line
}

/// The methods as lines under their window's row.
pub fn methods(methods: &Methods) -> String {
    let mut lines = String::new();
    for (i, m) in methods.methods.iter().enumerate() {
        lines += &format!(
            "{:>10} {:>9.6}{:9} {:>9.6}{:9} {:>9.5}{:9} rank {}\n",
            format!("method {}", i + 1),
            m.main_amplitude,
            "",
            m.quadrature_amplitude,
            "",
            m.angle.to_degrees(),
            "",
            m.rank,
        );
    }
    if methods.disagree {
        lines += &format!("  warning: {DISAGREE}\n");
    }
    lines
}
