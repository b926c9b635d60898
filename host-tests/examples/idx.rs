//! scratch
use antinode::block::Demodulator;
use antinode::settings::Settings;
use antinode::tracker::Tracker;
use antinode_sim::{Flaws, Gyro, random_wave};
fn main() {
    let fs = 1e5; let p: f64 = std::env::args().nth(2).unwrap().parse().unwrap(); let n: u16 = std::env::args().nth(1).unwrap().parse().unwrap();
    let noise = 0.02; let mut s = vec![0f64; 16]; let mut r = vec![0f64; 16];
    let runs = 3000;
    for seed in 0..runs {
        let w = random_wave(seed, fs / p, 0.5);
        let flaws = Flaws { noise: noise * w.main_amplitude, ..Flaws::default() };
        let mut gyro = Gyro::new(w, flaws, fs, seed + 77).unwrap();
        let settings = Settings { periods: n, ..Settings::new(fs) };
        let layout = settings.layout(p as f32);
        let mut demod = Demodulator::<256>::new(layout, 0);
        let mut tracker = Tracker::<256>::new(settings).unwrap();
        let mut got = 0;
        while got < 16 {
            let x = gyro.next().unwrap();
            let Some(b) = demod.push([x.c as f32, x.d as f32]) else { continue };
            let Some(e) = tracker.push(b) else { continue };
            let t = w.at(e.time);
            let bd = host_tests::bound::bound(&w, e.samples, e.time, fs);
            let sg = noise * w.main_amplitude;
            s[got] += ((e.frequency - t.frequency) / bd.frequency / sg).powi(2);
            r[got] += (e.frequency_std as f64 / bd.frequency / sg).powi(2);
            got += 1;
        }
    }
    for i in 0..16 { println!("{i} {:.3} {:.3}", (s[i] / runs as f64).sqrt(), (r[i] / runs as f64).sqrt()); }
}
