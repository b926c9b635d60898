//! A device's reports in words.

use antinode::Detection;
use antinode_telemetry::{Configuration, Counters, FrontEnd, Hello, Methods};

use crate::digits::{counted, significant};
use crate::methods::table::DISAGREE;

/// The device's version and configuration in one line.
pub fn hello(hello: &Hello) -> String {
    let shown = parts(hello).into_iter().filter(|(_, is_shown)| *is_shown);
    let shown: Vec<_> = shown.map(|(part, _)| part).collect();
    shown.join(", ")
}

/// What differs in a device's version and configuration, as it is and as it was; `None` if nothing does.
pub fn differences(now: &Hello, before: &Hello) -> Option<String> {
    let pairs = parts(now).into_iter().zip(parts(before));
    let differing = pairs.filter(|(now, before)| now.0 != before.0);
    let (now, before): (Vec<_>, Vec<_>) = differing.map(|(now, before)| (now.0, before.0)).unzip();
    (!now.is_empty()).then(|| format!("{}; before: {}", now.join(", "), before.join(", ")))
}

/// The parts of a device's version and configuration, each with false if it is the usual one, which goes without saying.
fn parts(hello: &Hello) -> [(String, bool); 18] {
    let Configuration {
        settings: s,
        front_end,
        methods,
    } = &hello.configuration;
    let c = &s.calibration;
    let always = |part: String| (part, true);
    let known = |part: Option<String>, otherwise: &str| {
        let is_shown = part.is_some();
        (part.unwrap_or_else(|| otherwise.to_owned()), is_shown)
    };
    let switch = |is_on: bool, on: &str, off: &str, shown: bool| {
        (if is_on { on } else { off }.to_owned(), is_on == shown)
    };
    [
        always(format!("firmware {}", hello.firmware)),
        always(format!("protocol {}", hello.protocol)),
        always(source(*front_end).to_owned()),
        always(format!("{} Hz", s.sample_rate)),
        always(format!("window {} periods", s.periods)),
        always(match s.hop {
            None => "no hop".to_owned(),
            Some(blocks) => format!("hop {}", counted(blocks.into(), "block")),
        }),
        always(format!("methods {}", if *methods { "on" } else { "off" })),
        always(format!("gain ratio {}", c.gain_ratio)),
        always(format!("skew {} ns", nanoseconds(c.skew))),
        always(format!("pick-off angle {} rad", c.pick_off_angle)),
        always(format!("start angle {} rad", s.start_angle)),
        known(
            s.rails.map(|[low, high]| format!("rails {low} and {high}")),
            "no rails",
        ),
        known(
            s.resolution.map(|x| format!("resolution {x}")),
            "no resolution",
        ),
        known(
            s.frequency.map(|hertz| format!("frequency {hertz} Hz")),
            "frequency searched for",
        ),
        switch(
            s.detection == Detection::MeanReturn,
            "detector mean-return",
            "usual detector",
            true,
        ),
        switch(s.watch, "samples watched", "samples not watched", false),
        switch(s.hum, "hum", "no hum", true),
        switch(s.coloured, "coloured noise", "white noise", true),
    ]
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
