"""The recorder with its real process and real files, killed in every way."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from hil_fakes import make_session
from mcap.reader import make_reader

from hil.errors import BackendError, InputError
from hil.loop import Loop
from hil.record_layout import message_definition, parse_definition, tick_dtype, topic_dtype, topics
from hil.recorder import Recorder
from hil.recorder_ring import Ring
from hil.recording import read_recording
from hil.run_folder import make_meta
from hil.trace import TraceSink

HERE = Path(__file__).parent

ENDLESS_RUN = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[2])
from hil_fakes import make_session
from hil.clock import MonotonicClock
from hil.loop import Loop
from hil.recorder import Recorder
from hil.run_folder import make_meta

session = make_session(world=True, clock=MonotonicClock(), duration_s=1e4, realtime=True)
recorder = Recorder(Path(sys.argv[1]), make_meta(session), truth=True, progress=False)
print(recorder._process.pid, flush=True)
Loop(session, (recorder,), sits=False).run()
"""


def record(folder, **request):
    session = make_session(world=True, **request)
    trace = TraceSink(12, 300)
    recorder = Recorder(folder, make_meta(session), truth=True, progress=False)
    with recorder:
        session.backend.open()
        Loop(session, (trace, recorder), sits=False).run()
    return session, trace.trace(), recorder


def test_every_tick_is_in_the_file_as_the_loop_had_it(tmp_path):
    session, trace, recorder = record(tmp_path)
    recording = read_recording(tmp_path)
    assert recording.complete and recorder.dropped == 0
    assert recording.rows["timing"]["tick"].tolist() == list(range(-450, 300))
    assert recording.rows["time_s"][-1] == pytest.approx(299 / 300)
    written = np.array(session.backend.written)
    assert np.array_equal(recording.rows["applied"]["position"], written)
    assert recording.meta["joints"] == list(session.description.joint_names)
    again = recording.trace()
    for name in ("time_s", "com", "joint_position", "steps", "speed", "cycle_ns"):
        assert np.array_equal(getattr(again, name), getattr(trace, name)), name


def test_the_file_is_one_that_any_mcap_reader_opens(tmp_path):
    record(tmp_path)
    with (tmp_path / "session.mcap").open("rb") as stream:
        reader = make_reader(stream)
        summary = reader.get_summary()
        topics_seen = {channel.topic for channel in summary.channels.values()}
        assert topics_seen == {
            *("/command", "/applied", "/frame", "/estimate", "/reference", "/status", "/safety"),
            *("/timing", "/truth"),
        }
        assert set(summary.statistics.channel_message_counts.values()) == {750}
        times = [message.log_time for _, _, message in reader.iter_messages(topics="/timing")]
    grid = np.diff(times)
    assert grid.min() >= 3_333_333 and grid.max() <= 3_333_334


def test_a_layout_survives_its_message_definition():
    for part in topics(7, truth=True).values():
        layout = topic_dtype(part)
        assert parse_definition(message_definition(layout)) == layout


def test_cdr_needs_no_padding_because_wide_fields_come_first():
    for part in topics(5, truth=True).values():
        layout = topic_dtype(part)
        offsets = [(layout.fields[name][1], layout[name].base.itemsize) for name in layout.names]
        assert all(offset % size == 0 for offset, size in offsets)


@pytest.mark.parametrize("text", ["float32 x", "float64[] x", "nonsense"])
def test_a_definition_of_something_else_is_refused(text):
    with pytest.raises(ValueError, match="not a field"):
        parse_definition(text)


def start_endless_run(folder):
    process = subprocess.Popen(
        [sys.executable, "-c", ENDLESS_RUN, str(folder), str(HERE)],
        stdout=subprocess.PIPE,
        cwd=HERE.parent.parent,
    )
    writer = int(process.stdout.readline())
    file = folder / "session.mcap"
    wait_for(lambda: file.exists() and file.stat().st_size > 20_000)
    return process, writer


def wait_for(condition, timeout_s=20.0):
    deadline = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < deadline, "waited too long"
        time.sleep(0.02)


def running(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    status = Path(f"/proc/{pid}/stat")
    return not (status.exists() and ") Z " in status.read_text())


def test_a_killed_run_leaves_a_finished_recording(tmp_path):
    process, writer = start_endless_run(tmp_path)
    process.kill()
    process.wait()
    wait_for(lambda: not running(writer))
    recording = read_recording(tmp_path)
    assert recording.complete
    ticks = recording.rows["timing"]["tick"]
    assert ticks[0] == -450 and len(ticks) >= 50


def test_a_killed_recorder_too_leaves_one_that_can_be_read(tmp_path):
    process, writer = start_endless_run(tmp_path)
    os.kill(writer, signal.SIGKILL)
    process.kill()
    process.wait()
    recording = read_recording(tmp_path)
    assert not recording.complete
    ticks = recording.rows["timing"]["tick"]
    assert ticks[0] == -450 and len(ticks) >= 50
    assert np.diff(ticks).min() > 0  # a busy machine may skip some


def test_every_cut_of_a_file_reads_as_a_beginning_of_it(tmp_path):
    record(tmp_path)
    whole = read_recording(tmp_path).rows
    data = (tmp_path / "session.mcap").read_bytes()
    cut_folder = tmp_path / "cut"
    cut_folder.mkdir()
    lengths = []
    for size in np.linspace(len(data) // 50, len(data) - 1, 23).astype(int):
        (cut_folder / "session.mcap").write_bytes(data[:size])
        try:
            rows = read_recording(cut_folder).rows
        except InputError:  # cut before the first chunk
            rows = whole[:0]
        assert rows.tobytes() == whole[: len(rows)].tobytes()
        lengths.append(len(rows))
    assert lengths == sorted(lengths) and lengths[-1] == len(whole)


@pytest.mark.parametrize("content", [b"", b"not mcap at all", b"\x89MCAP0\r\n"])
def test_what_is_no_recording_is_an_input_error(tmp_path, content):
    with pytest.raises(InputError, match=r"no session\.mcap"):
        read_recording(tmp_path)
    (tmp_path / "session.mcap").write_bytes(content)
    with pytest.raises(InputError, match="no recording of ours"):
        read_recording(tmp_path)


def test_in_real_time_a_full_ring_drops_and_counts(tmp_path):
    session = make_session(world=True, realtime=True, duration_s=20.0)
    meta = make_meta(session)
    recorder = Recorder(tmp_path, meta, truth=True, progress=False)
    os.kill(recorder._process.pid, signal.SIGSTOP)
    try:
        session.backend.open()
        Loop(session, (recorder,), sits=False).run()
    finally:
        os.kill(recorder._process.pid, signal.SIGCONT)
    recorder.close()
    recorded = len(read_recording(tmp_path).rows)
    assert recorder.dropped > 0
    assert recorded + recorder.dropped == 6450


def test_in_lockstep_nothing_is_dropped_however_slow_the_disk(tmp_path):
    session = make_session(world=True, duration_s=20.0)
    recorder = Recorder(tmp_path, make_meta(session), truth=True, progress=False)
    with recorder:
        session.backend.open()
        Loop(session, (recorder,), sits=False).run()
    assert recorder.dropped == 0
    assert len(read_recording(tmp_path).rows) == 6450


def test_the_ring_gives_back_what_was_put_across_its_end():
    dtype = tick_dtype(2, truth=False)
    ring = Ring.create(dtype)
    taken = []
    for number in range(ring.slots + 700):
        ring.rows["time_ns"][ring.next_row] = number
        ring.publish()
        if ring.waiting == 900:
            for piece in ring.take():
                taken += piece["time_ns"].tolist()
                ring.release(len(piece))
    taken += [number for piece in ring.take() for number in piece["time_ns"].tolist()]
    os.close(ring.descriptor)
    assert taken == list(range(ring.slots + 700))


def test_a_recorder_that_cannot_write_is_an_error_of_one_line(tmp_path, capfd):
    session = make_session(world=True)
    recorder = Recorder(tmp_path / "gone", make_meta(session), truth=True, progress=False)
    with pytest.raises(BackendError, match="recorder ended with status 1"):
        recorder.close()
    assert capfd.readouterr().err.count("\n") == 1
