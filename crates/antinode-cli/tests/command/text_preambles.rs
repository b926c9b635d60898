//! `antinode identify` on the CSV of oscilloscopes and recorders that write their settings above the samples, or beside them.

use std::path::Path;

use crate::common::{Row, WAVE, fault, rows_of, run_with, same_later, text};

/// The time of the first sample, s.
const START: f64 = -0.01;

/// A Tektronix of the series MDO3000, MSO4000 and others.
const TEKTRONIX: &str = "Model,MDO3014\nFirmware Version,1.26\n\nWaveform Type,ANALOG,,\nPoint Format,Y,,\nHorizontal Units,s,,\n\
    Horizontal Scale,0.004,,\nHorizontal Delay,0.019528,,\nSample Interval,1e-05,,\nRecord Length,5000,,\nGating,0.0% to 100.0%,,\n\
    Probe Attenuation,10,10,\nVertical Units,V,V,\nVertical Offset,0,0,\nVertical Scale,2,2,\nVertical Position,-1.98,0.5,\n,,,\n,,,\n,,,\n\
    Label,C,D,\nTIME,CH1,CH2\n";

/// A Siglent of the series SDS1000.
const SIGLENT: &str = "Record Length,Analog:5000\nSample Interval,CH1:0.0000100000000 CH2:0.0000100000000\nVertical Units,CH1:V CH2:V,,\n\
    Vertical Scale,CH1:0.05 CH2:0.10,,\nVertical Offset,CH1:-0.15000 CH2:0.20000,,\nHorizontal Units,us,,\nHorizontal Scale,0.0005,,\n\
    Model Number,SDS1202X-E,,\nSerial Number,SDS00001121687,,\nSoftware Version,3.01.01.31R16,,\n\nSource,CH1,CH2\nSecond,Volt,Volt\n";

/// The same, written by Siglent's own converter.
const SIGLENT_CONVERTED: &str = "Record Length,Analog:5000\nSample Rate,100000.0\nVertical Scale,CH1: 0.05 CH2: 0.10\n\
    Vertical Offset,CH1:0.00000 CH2:0.00000\nHorizontal Scale, 0.000010000\nSecond,Volt,Volt\n";

/// A Rohde & Schwarz of the series RTH.
const ROHDE: &str = "Model;RTH1004\nSerialNumber;103752\nFirmware Version;'1.80.3.4'\n\nAcquisition Time Stamp;2023-01-23 12:08:02.423888073;\
    2023-01-23 12:08:02.423888073\nWaveform Type;ANALOG;\nAcquisition Mode;PEAK;\nHorizontal Unit;s;\nHorizontal Scale;5e-07;\n\
    Horizontal Position;-2.504e-07;\nReference Point;50 %;\nSample Interval;1e-05;\nRecord Length;5000;\nProbe Setting;'100:1';'100:1'\n\
    Vertical Unit;V;V\nVertical Scale;5;5\nVertical Position;-1;-1\nVertical Offset;0;0\nHistory Index;0;0\n\
    History Time Stamp;0.000000000000;0.000000000000\n;;\nTIME;CH1;CH2\n";

/// A LeCroy, all channels in one file.
const LECROY: &str = "LECROYWS3024,12304,Waveform\nSegments,1,SegmentSize,5000\nSegment,TrigTime,TimeSinceSegment1\n\
    #1,24-Feb-2016 16:34:36,0                 \nTime,Ampl1,Ampl2\n";

/// A Keysight that keeps segments.
const KEYSIGHT: &str = "points/segment = 5000\nx-axis,1,2\nsecond,Volt,Volt\n";

/// A Hioki, without names right above the samples.
const HIOKI: &str = "\"COMMENT\",\"8807 MEM DATA\"\n\"DATE\",\"01-01-1999\"\n\"TIME\",\"15:26:55\"\n\"NUM_SIGS\",3\n\"INTERVAL\",1.000E-05\n\
    \"HORZ_UNITS\", \"S\"\n\"VERT_UNITS\", \"S\", \"V    \", \"V    \"\n\"SIGNAL\", \"TIME\", \"ACH1\", \"ACH2\"\n\"DATA\"\n";

/// LabVIEW's measurement file; `columns` says which have a time of their own.
fn labview(columns: &str, names: &str) -> String {
    format!(
        "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t.\nMulti_Headings\tNo\n\
         X_Columns\t{columns}\nTime_Pref\tRelative\nOperator\tlab\nDate\t2015/09/23\nTime\t15:07:04.9949688911437988282\n\
         ***End_of_Header***\t\n\t\nChannels\t2\t\t\nSamples\t5000\t5000\t\nDate\t2015/09/23\t2015/09/23\t\n\
         Time\t15:07:04.9949688911437988282\t15:07:04.9949688911437988282\t\nX_Dimension\tTime\tTime\t\n\
         X0\t0.0000000000000000E+0\t0.0000000000000000E+0\t\nDelta_X\t0.000010\t0.000010\t\n***End_of_Header***\t\t\t\n{names}\n"
    )
}

/// What a Tektronix of the series TDS1000 and TDS2000 writes beside its first samples.
const BESIDE: [&str; 18] = [
    "Record Length,5.000000e+03,",
    "Sample Interval,1.000000e-05,",
    "Trigger Point,2.500000e+03,",
    ",,",
    ",,",
    ",,",
    "Source,CH1,",
    "Vertical Units,V,",
    "Vertical Scale,2.000000e-01,",
    "Vertical Offset,0.000000e+00,",
    "Horizontal Units,s,",
    "Horizontal Scale,5.000000e-03,",
    "Pt Fmt,Y,",
    "Yzero,0.000000e+00,",
    "Probe Atten,1.000000e+00,",
    "Model Number,TDS2002B,",
    "Serial Number,C100001,",
    "Firmware Version,FV:v22.11,",
];

/// A recording below these lines; `print` makes its lines of their number, their time and their samples.
fn recording(above: &str, print: impl Fn(usize, f64, [f64; 2]) -> String) -> String {
    let mut text = above.to_owned();
    for (k, pair) in WAVE.codes(5000).iter().enumerate() {
        let pair = pair.map(|code| f64::from(code) / 32_768.0);
        text += &print(k, START + k as f64 * 1e-5, pair);
        text += "\n";
    }
    text
}

/// Prints time and samples with this separator between them.
fn timed(mark: char) -> impl Fn(usize, f64, [f64; 2]) -> String {
    move |_, time, [c, d]| format!("{time:.5}{mark}{c}{mark}{d}")
}

/// The recording of a TDS: of C, or of D.
fn beside(channel: usize) -> String {
    recording("", |k, time, pair| {
        let settings = BESIDE.get(k).copied().unwrap_or(",,");
        format!("{settings},{time:.12},{:>20},", pair[channel])
    })
}

/// Two files side by side, as `paste -d,` puts them.
fn pasted(c: &str, d: &str) -> String {
    let both = c.lines().zip(d.lines()).map(|(c, d)| format!("{c},{d}\n"));
    both.collect()
}

/// Asserts that the rows are those expected, from a file and from a pipe, without a message.
fn same(here: &Path, text: &str, arguments: &str, expected: &[Row], later: f64) {
    same_later(&rows_of(here, text, arguments), expected, later);
    let arguments = format!("identify --output csv - {arguments}");
    let run = run_with(here, &arguments, text.as_bytes().to_vec());
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    same_later(&Row::all(&run.out), expected, later);
}

#[test]
fn settings_above_the_samples_are_skipped_but_no_sample() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(5000)), "");
    for above in [
        TEKTRONIX,
        SIGLENT,
        SIGLENT_CONVERTED,
        LECROY,
        KEYSIGHT,
        HIOKI,
    ] {
        let text = recording(above, timed(','));
        same(here, &text, "", &expected, START);
        same(here, &text.replace('\n', "\r\n"), "", &expected, START);
        same(here, &text, "--columns 2,3 --rate 1e5", &expected, 0.0);
    }
    same(here, &recording(ROHDE, timed(';')), "", &expected, START);
    let names = recording(TEKTRONIX, timed(','));
    same(here, &names, "--columns TIME,CH1,CH2", &expected, START);
}

#[test]
fn the_columns_of_labview_are_found_by_their_numbers() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(5000)), "");
    let one = labview("One", "X_Value\tUntitled\tUntitled 1\tComment");
    for tail in ["", "\t"] {
        let text = recording(&one, |_, time, [c, d]| format!("{time:.5}\t{c}\t{d}{tail}"));
        same(here, &text, "", &expected, START);
        // With decimal commas.
        same(here, &text.replace('.', ","), "", &expected, START);
    }
    let none = labview("No", "X_Value\tUntitled\tUntitled 1\tComment");
    let text = recording(&none, |_, _, [c, d]| format!("\t{c}\t{d}"));
    same(here, &text, "", &expected, 0.0);
    same(here, &text.replace('.', ","), "", &expected, 0.0);
    // Of three channels none is taken for a time.
    let text = recording(
        &none.replace("Untitled 1", "Untitled 1\tUntitled 2"),
        |_, _, [c, d]| format!("\t{c}\t{d}\t{c}"),
    );
    same(here, &text, "--columns 2,3", &expected, 0.0);
    fault(
        here,
        "-",
        text.into(),
        &["input:22: found 3 columns, but two"],
    );
    let multi = labview("Multi", "X_Value\tc0\tX_Value\td0\tComment");
    let text = recording(&multi, |_, t, [c, d]| format!("{t:.5}\t{c}\t{t:.5}\t{d}"));
    same(here, &text, "--columns 1,2,4", &expected, START);
    fault(
        here,
        "- --rate 1e5",
        text.into(),
        &["input:22: found 4 columns, but two"],
    );
}

#[test]
fn a_file_of_one_channel_is_refused_and_two_side_by_side_are_read() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(5000)), "");
    let [c, d] = [0, 1].map(beside);
    let told = "found the time and one signal, but both S_C and S_D are needed; export both channels to one file";
    fault(here, "- --rate 1e5", c.clone().into(), &["input:1: ", told]);
    let columns = "if 4 and 10 are the times of 5 and 11, give --columns 4,5,11";
    fault(here, "-", pasted(&c, &d).into(), &["input:1: ", columns]);
    same(here, &pasted(&c, &d), "--columns 4,5,11", &expected, START);
    let above = LECROY.replace("Ampl1,Ampl2", "Ampl");
    let [c, d] = [0, 1].map(|channel| {
        recording(&above, |_, time, pair| {
            format!("{time:.5},{}", pair[channel])
        })
    });
    fault(here, "- --rate 1e5", c.clone().into(), &["input:5: ", told]);
    same(here, &pasted(&c, &d), "--columns 1,2,4", &expected, START);
    // Files of Windows, where each keeps its own end of line.
    let windows = pasted(&c, &d).replace('\n', "\r\n");
    let windows: String = windows
        .lines()
        .zip(c.lines())
        .map(|(both, c)| format!("{c}\r{}\r\n", &both[c.len()..]))
        .collect();
    assert!(windows.contains("\r,"));
    same(here, &windows, "--columns 1,2,4", &expected, START);
    // Without a name above the samples.
    let above = HIOKI.replace(", \"ACH2\"", "");
    let text = recording(&above, |_, time, [c, _]| format!("{time:.5}, {c}"));
    fault(here, "- --rate 1e5", text.into(), &["input:10: ", told]);
}

#[test]
fn the_last_setting_may_have_more_than_one_field() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(
        here,
        &recording("c,d\n", |_, _, [c, d]| format!("{c},{d}")),
        "--rate 1e5",
    );
    // Yokogawa's DL850, written by a converter.
    let above = "TraceName, CH1, CH2\nVUnit, V, V\nHResolution, 1e-5\nHOffset, -0.01\nHUnit, s\nBlockSize, 5000\nModel, DL850E\n\
        Date, 2026-06-30\n";
    let text = recording(above, |_, _, [c, d]| format!(",{c},{d}"));
    same(here, &text, "", &expected, START);
    let told = ["does not state its sample rate"];
    fault(
        here,
        "-",
        text.replace("HUnit, s", "HUnit, Hz").into(),
        &told,
    );
    let told = "the sample rate is 100000 Hz by its settings and 50000 Hz by --rate, which takes precedence";
    let run = run_with(here, "identify - --rate 5e4", text.into_bytes());
    assert!(run.code == 0 && run.err.contains(told), "{}", run.err);
    // And written by Yokogawa's viewer, where units of time stand above both signals.
    let above = "\"Model\",\"Xviewer\"\n\"BlockNumber\",\"1\"\n\"TraceName\",\"CH1\",\"CH2\",\nBlockSize,5000,5000,\nVUnit,V,V,\n\
        HResolution,1e-05,1e-05,\nHOffset,-1e-02,-1e-02,\nHUnit,s,s,\n";
    let text = recording(above, |_, _, [c, d]| format!(",{c},{d}"));
    same(here, &text, "", &expected, START);
    // If the channels have different steps, does not state its sample rate.
    let text = text.replace("1e-05,1e-05", "1e-05,2e-05");
    same(here, &text, "--rate 1e5", &expected, 0.0);
    fault(here, "-", text.into(), &["does not state its sample rate"]);
}

#[test]
fn both_channels_of_gw_instek_side_by_side_are_read() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(5000)), "");
    let above = "Memory Length,5000,\nTrigger Level,1.8e+01,\nSource,CH1,\nProbe,1.0X,\nVertical Units,V,\nHorizontal Units,S,\n\
        Sampling Period,1.0e-05,\nFirmware,V1.14,\nTime, ,\nMode,Detail,\nWaveform Data,\n";
    let [c, d] = [0, 1].map(|channel| {
        recording(above, |_, time, pair| {
            format!("{time:.6e},{},", pair[channel])
        })
    });
    let both = c.lines().zip(d.lines()).map(|(c, d)| format!("{c}{d}\n"));
    let both: String = both.collect();
    same(here, &both, "--columns 1,2,4", &expected, START);
    fault(
        here,
        "-",
        both.into(),
        &["input:12: found 4 columns", "give --columns 1,2,4"],
    );
}

#[test]
fn a_comment_behind_each_line_of_labview_is_no_sample() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let expected = rows_of(here, &text(&WAVE.codes(5000)), "");
    let above = labview("One", "X_Value\tc0\td0\tComment");
    let text = recording(&above, |_, time, [c, d]| {
        format!("{time:.5}\t{c}\t{d}\tLOST COMMUNICATION")
    });
    std::fs::write(here.join("a.lvm"), text).unwrap();
    same_later(&crate::common::rows(here, "a.lvm"), &expected, START);
}

#[test]
fn one_channel_of_labview_is_no_pair() {
    let directory = tempfile::tempdir().unwrap();
    let text = recording(
        &labview("One", "X_Value\tAcceleration"),
        |_, time, [c, _]| format!("{time:.5}\t{c}"),
    );
    let told = ["input:22: found the time and one signal, but both S_C and S_D are needed"];
    assert!(fault(directory.path(), "-", text.into(), &told).is_empty());
}

#[test]
fn lines_count_from_the_first_of_the_settings() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let mut text = recording(TEKTRONIX, timed(','));
    let place = text.match_indices('\n').nth(3020).unwrap().0;
    text.replace_range(place..place, "x");
    fault(
        here,
        "-",
        text.into(),
        &["input:3021:3: sample pair 2999 (from 0), S_D"],
    );
    // A garbled sample near the beginning is still a sample.
    let text = recording(TEKTRONIX, |k, time, [c, d]| match k {
        1 => format!("{time:.5},OVER,x"),
        _ => format!("{time:.5},{c},{d}"),
    });
    let told = ["input:23:2: sample pair 1 (from 0), S_C (left): the value is `OVER`"];
    assert_eq!(fault(here, "-", text.into(), &told).len(), 25);
}

#[test]
fn a_unit_of_time_that_only_settings_name_is_not_assumed() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    for above in [TEKTRONIX, HIOKI] {
        let above = above.replace("Horizontal Units,s", "Horizontal Units,ms");
        let above = above.replace("\"HORZ_UNITS\", \"S\"", "\"HORZ_UNITS\", \"mS\"");
        let text = recording(&above, timed(','));
        let told = [
            "input:6: the settings give the time in `m",
            "`TIME [ms]`, or ignore",
        ];
        assert!(fault(here, "-", text.clone().into(), &told).is_empty());
        let expected = rows_of(
            here,
            &recording("c,d\n", |_, _, [c, d]| format!("{c},{d}")),
            "--rate 1e5",
        );
        same(here, &text, "--columns 2,3 --rate 1e5", &expected, 0.0);
    }
}

#[test]
fn lines_that_may_be_samples_are_never_skipped() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    // Among the settings, a line with numbers in all columns of the samples, or with one at its front.
    for line in ["0.5,0.1,0.2", "Offset,1,0.1,0.2", "1e-5,s"] {
        let above = TEKTRONIX.replace("Gating,0.0% to 100.0%,,", line);
        let extra = line.starts_with("Offset");
        let text = recording(&above, |_, time, [c, d]| {
            let front = if extra { "x," } else { "" };
            format!("{front}{time:.5},{c},{d}")
        });
        let run = run_with(here, "identify - --rate 1e5 --output csv", text.into());
        assert_eq!((run.code, run.out.as_str()), (1, ""), "{line}");
        assert!(run.err.contains("standard input:2:1: "), "{}", run.err);
    }
}
