"""antinode.py, of PYTHONPATH or else of examples, against the header and the rows of `antinode identify`:  python.py RECORDING.wav ROWS.csv"""

import csv
import ctypes
import pathlib
import re
import sys
import wave

import numpy

folder = pathlib.Path(__file__).parent.parent
sys.path.append(str(folder / "examples"))
import antinode

header = (folder / "include/antinode.h").read_text()


def fields(struct):
    """Names and sizes of a struct's fields in the header, those of the calibration in its place."""
    body = re.search(r"typedef struct \w+ \{([^}]*)\} " + struct + ";", header).group(1)
    found = []
    for kind, name in re.findall(r"^\s+(?:struct )?(\w+) (\w+);", body, re.M):
        sizes = {"uint64_t": 8, "double": 8, "uint32_t": 4, "float": 4}
        found += [(name, sizes[kind])] if kind in sizes else fields(kind)
    return found


window = [(name, antinode.WINDOW[name].itemsize) for name in antinode.WINDOW.names]
assert window == fields("antinode_estimate_t"), window
settings = [(name, ctypes.sizeof(kind)) for name, kind in antinode._Settings._fields_]
assert settings == fields("antinode_settings_t"), settings
health = [(name, ctypes.sizeof(kind)) for name, kind in antinode._Health._fields_]
assert health == fields("antinode_health_t"), health
assert f"#define ANTINODE_HEADER_VERSION {antinode.VERSION}u\n" in header
for bit, name in enumerate(antinode.FLAGS):
    assert f"#define ANTINODE_FLAG_{name.upper()} {1 << bit}u" in header, name

with wave.open(sys.argv[1]) as file:
    rate = file.getframerate()
    samples = numpy.frombuffer(file.readframes(file.getnframes()), "<i2").reshape(-1, 2) / 32768
step = 1 / 32768
silent = antinode.Gyro(rate)
assert len(silent.push(numpy.zeros((100_000, 2)))) == 0 and not silent.has_wave
whole = antinode.Gyro(rate, resolution=step, rail_low=step - 1, rail_high=1 - step).push(samples)
gyro = antinode.Gyro(rate, resolution=step, rail_low=step - 1, rail_high=1 - step)
windows = numpy.concatenate([gyro.push(part) for part in numpy.array_split(samples, 77)])
rows = list(csv.DictReader(open(sys.argv[2], encoding="utf-8")))
assert len(windows) == len(rows) > 100, (len(windows), len(rows))
assert len(samples) > antinode.AT_ONCE and whole.tobytes() == windows.tobytes()
assert gyro.has_wave
names = [name for name in antinode.WINDOW.names if name in rows[0] and name != "flags"]
assert len(names) == 19, names
for name in names:
    values = windows[name]
    theirs = numpy.array([float(row[name]) for row in rows])
    # The rows round numbers of double precision.
    rounding = 1e-9 if values.dtype == "f8" else 0
    assert numpy.all(numpy.abs(values - theirs.astype(values.dtype)) <= rounding), name
for ours, row in zip(windows["flags"], rows):
    assert "+".join(name for bit, name in enumerate(antinode.FLAGS) if ours >> bit & 1) == row["flags"]

# What lies under a mask is not seen, whatever its type.
codes = (samples / step).astype("i2")
codes[20_000] = 0
masked = numpy.ma.masked_array(codes, numpy.zeros(codes.shape, bool))
masked[20_000, 1] = numpy.ma.masked
flags = antinode.Gyro(rate).push(masked)["flags"]
assert numpy.any(flags & 1 << antinode.FLAGS.index("not_finite")), flags

for wrong, told in [
    (lambda: antinode.Gyro(0), "sample_rate_hz"),
    (lambda: antinode.Gyro(rate, period=3), "period"),
    (lambda: antinode.Gyro(rate, periods=2**32 + 10), "periods cannot be 4294967306"),
    (lambda: gyro.push(samples[:, 0]), "(N, 2)"),
    (lambda: gyro.skip(-1), "-1"),
]:
    try:
        wrong()
    except (TypeError, ValueError) as error:
        assert told in str(error), error
    else:
        raise AssertionError(told)
assert len(gyro.push(samples[:3])) == 0
print(f"{len(windows)} windows are the same")
