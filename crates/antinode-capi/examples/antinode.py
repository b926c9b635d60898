"""The wave of two pick-off signals from Python: a numpy array of samples in, a numpy array of windows out.

    import antinode

    gyro = antinode.Gyro(100e3, periods=50)        # Hz; settings as antinode_settings_t has them
    windows = gyro.push(samples)                   # samples: (N, 2), S_C and S_D; again and again, as they come
    clean = windows[windows["flags"] == 0]
    clean["angle_rad"], clean["angle_std_rad"]     # fields as antinode_estimate_t has them

The command `antinode identify` takes the converter's step and rails from the format of a recording; here give `resolution`, `rail_low` and
`rail_high`, such as 1/32768 and ±32767/32768 for 16 bits. A window has at most 50 periods, and a period at most 200 samples. Samples are
taken in single precision, and a wave with an offset of more than 400 times its amplitude may not be found: subtract a constant then.
One thread at a time may use a Gyro, since calls let other threads run.

Needs numpy and the shared library. On Linux `crates/antinode-capi/install PREFIX` installs both, this file in PREFIX/share/antinode, where
it finds the library by itself; if the library is elsewhere, name it in ANTINODE_LIBRARY. On other systems
`cargo rustc --profile capi -p antinode-capi --lib --crate-type cdylib` builds it in target/capi. Built together with the static library, as
by `cargo build`, it would not load on Linux.
"""

import ctypes
import os

import numpy

#: The version of the header that this file was written for, and ANTINODE_ESTIMATE.
VERSION = 256
WINDOW_ENDED = 2
#: Sample pairs converted to single precision at a time.
AT_ONCE = 1 << 16

#: antinode_estimate_t: one window.
WINDOW = numpy.dtype(
    [("start", "u8")]
    + [(name, "f8") for name in ("time_s", "angle_rad", "frequency_hz")]
    + [(name, "u4") for name in ("samples", "flags")]
    + [
        (name, "f4")
        for name in (
            "main_amplitude", "quadrature_amplitude", "phase_rad", "angle_rate_rad_s", "decay_rate_s", "offset_c", "offset_d",
            "main_amplitude_std", "quadrature_amplitude_std", "angle_std_rad", "phase_std_rad", "frequency_std_hz",
            "angle_rate_std_rad_s", "decay_rate_std_s", "residual_rms",
        )
    ]
    + [("reserved", "u4")]
)  # fmt: skip

#: Names of the bits of `flags`, from the lowest.
FLAGS = ("clipped", "lost", "phase_jump", "step", "circular", "misfit", "dead_channel", "reacquired", "not_finite")


class _Settings(ctypes.Structure):
    """antinode_settings_t, with the fields of its antinode_calibration_t in their place."""

    _fields_ = [
        ("sample_rate_hz", ctypes.c_double),
        ("periods", ctypes.c_uint32),
        ("hop_blocks", ctypes.c_uint32),
        ("start_angle_rad", ctypes.c_float),
        ("rail_low", ctypes.c_float),
        ("rail_high", ctypes.c_float),
        ("resolution", ctypes.c_float),
        ("frequency_hz", ctypes.c_float),
        ("detection", ctypes.c_uint32),
        ("watch", ctypes.c_uint32),
        ("gain_ratio", ctypes.c_float),
        ("skew_s", ctypes.c_float),
        ("pick_off_angle_rad", ctypes.c_float),
        ("hum", ctypes.c_uint32),
        ("coloured", ctypes.c_uint32),
    ]


class _Health(ctypes.Structure):
    _fields_ = [(name, ctypes.c_uint32) for name in ("searching", "has_wave", "waiting", "dropped")]


#: Where `install` puts the library beside this file.
_installed = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../lib/libantinode.so")
_library = ctypes.CDLL(os.environ.get("ANTINODE_LIBRARY", _installed if os.path.exists(_installed) else "libantinode.so"))
_library.antinode_settings_default.argtypes = [ctypes.c_double]
_library.antinode_settings_default.restype = _Settings
_library.antinode_status_string.restype = ctypes.c_char_p
_library.antinode_float_health.argtypes = [ctypes.c_void_p, ctypes.POINTER(_Health)]
_library.antinode_float_skip.argtypes = [ctypes.c_void_p, ctypes.c_uint32]
_identify = _library.antinode_float_identify
_identify.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_size_t, ctypes.POINTER(ctypes.c_size_t), ctypes.c_void_p]
_library.antinode_float_size.restype = ctypes.c_size_t
# The last eight bits are the patch, which changes no type and no function.
if _library.antinode_version() >> 8 != VERSION >> 8:
    raise ImportError(f"antinode {VERSION:#x} is wanted, and the library is {_library.antinode_version():#x}")


def _check(status):
    if status < 0:
        raise ValueError(_library.antinode_status_string(status).decode())
    return status


class Gyro:
    """One stream of sample pairs, identified window by window."""

    def __init__(self, sample_rate_hz, **settings):
        """Starts from cold, at this sample rate in Hz; `settings` are those of antinode_settings_t and antinode_calibration_t, by name."""
        wanted = _library.antinode_settings_default(sample_rate_hz)
        for name, value in settings.items():
            if name not in dict(_Settings._fields_):
                raise TypeError(f"no setting is called {name}")
            setattr(wanted, name, value)
            # ctypes wraps integers that are too large.
            if isinstance(getattr(wanted, name), int) and getattr(wanted, name) != value:
                raise ValueError(f"{name} cannot be {value}")
        self._state = numpy.zeros(_library.antinode_float_size() // 8, "u8")
        _check(_library.antinode_float_init(ctypes.c_void_p(self._state.ctypes.data), ctypes.byref(wanted)))

    def push(self, samples):
        """Returns the windows that these sample pairs complete, an array of WINDOW; samples have shape (N, 2) and any unit.

        A sample that is masked counts as one that is not finite.
        """
        if not isinstance(samples, numpy.ndarray):
            samples = numpy.asarray(samples, "f4")
        if samples.ndim != 2 or samples.shape[1] != 2:
            raise ValueError(f"samples are to be of shape (N, 2), not {samples.shape}")
        windows, window, taken = bytearray(), numpy.zeros(1, WINDOW), ctypes.c_size_t()
        for begin in range(0, len(samples), AT_ONCE):
            pairs, at = samples[begin : begin + AT_ONCE], 0
            if isinstance(pairs, numpy.ma.MaskedArray):
                pairs = pairs.astype("f4").filled(numpy.nan)
            pairs = numpy.ascontiguousarray(pairs, "f4")
            while at < len(pairs):
                here = pairs.ctypes.data + at * pairs.strides[0]
                status = _identify(self._state.ctypes.data, here, len(pairs) - at, ctypes.byref(taken), window.ctypes.data)
                if _check(status) == WINDOW_ENDED:
                    windows += window.tobytes()
                at += taken.value
        return numpy.frombuffer(windows, WINDOW)

    @property
    def has_wave(self):
        """Whether the last window showed a wave. If no wave is found there are no windows, and only this shows it."""
        health = _Health()
        _check(_library.antinode_float_health(self._state.ctypes.data, ctypes.byref(health)))
        return bool(health.has_wave)

    def skip(self, pairs):
        """Reports that so many sample pairs, fewer than 2**32, were lost before the next one."""
        if not 0 <= pairs < 1 << 32:
            raise ValueError(f"{pairs} pairs cannot be skipped at once")
        _check(_library.antinode_float_skip(self._state.ctypes.data, pairs))
