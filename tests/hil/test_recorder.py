"""The recorder with its real process and real files, killed in every way."""

import contextlib
import os
import signal
import struct
import subprocess
import sys
import time
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from hil_fakes import make_session
from mcap.exceptions import McapError
from mcap.reader import NonSeekingReader, make_reader
from mcap.writer import MCAP0_MAGIC
from mcap_ros2.decoder import DecoderFactory

from hil.errors import BackendError, InputError
from hil.export import write_mcap
from hil.loop import Loop
from hil.record_layout import message_definition, parse_definition, tick_dtype, topic_dtype, topics
from hil.recorder import Recorder
from hil.recorder_ring import Ring
from hil.recording import RECORD_HEADER, Recording, read_recording
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


@pytest.fixture
def small_chunks(tmp_path, monkeypatch):
    """A recording of several chunks, its bytes, and how long it is at the end of every record."""
    monkeypatch.setattr("hil.recorder_file.CHUNK_BYTES", 20_000)
    record(tmp_path)
    recording = read_recording(tmp_path)
    write_mcap(Recording(recording.meta, recording.rows[:120], True), tmp_path / "small.mcap")
    data = (tmp_path / "small.mcap").read_bytes()
    ends, end = [], len(MCAP0_MAGIC)
    while end + RECORD_HEADER.size <= len(data):
        end += RECORD_HEADER.size + RECORD_HEADER.unpack_from(data, end)[1]
        ends.append(end)
    return recording.rows[:120], data, ends


def cuts(data, ends):
    """Lengths at, before and behind the end of every record, and some anywhere."""
    around = {end + shift for end in ends[::2] for shift in (-1, 0, 5)}
    anywhere = np.random.default_rng(1).integers(0, len(data), 20).tolist()
    return sorted(size for size in around | set(anywhere) if 0 <= size < len(data))


def test_every_cut_of_a_file_reads_as_a_beginning_of_it(tmp_path, small_chunks):
    whole, data, ends = small_chunks
    lengths = []
    for size in cuts(data, ends):
        (tmp_path / "session.mcap").write_bytes(data[:size])
        try:
            recording = read_recording(tmp_path)
        except InputError:  # cut before the first chunk
            lengths.append(0)
            continue
        assert recording.rows.tobytes() == whole[: len(recording.rows)].tobytes()
        assert not recording.complete or size > ends[-3]
        lengths.append(len(recording.rows))
    assert lengths == sorted(lengths) and lengths[-1] == len(whole)
    assert len(set(lengths)) >= 5  # a chunk more, some ticks more


def test_the_readers_of_the_mcap_package_read_a_cut_file_up_to_its_last_whole_chunk(
    tmp_path, small_chunks
):
    _, data, ends = small_chunks
    for size in cuts(data, ends):
        theirs = read_as_far_as_it_goes(data[:size])
        (tmp_path / "session.mcap").write_bytes(data[:size])
        try:
            ours = len(read_recording(tmp_path).rows)
        except InputError:
            ours = 0
        assert theirs == ours


def read_as_far_as_it_goes(data):
    """Whole ticks that mcap's own streaming reader gives of a file."""
    counts = dict.fromkeys(range(1, 10), 0)
    messages = NonSeekingReader(BytesIO(data)).iter_messages(log_time_order=False)
    with contextlib.suppress(McapError, struct.error):
        for _, channel, _ in messages:
            counts[channel.id] += 1
    return min(counts.values())


def test_a_cut_file_is_mended_for_tools_that_want_its_end(tmp_path, small_chunks):
    whole, data, _ = small_chunks
    (tmp_path / "session.mcap").write_bytes(data[: len(data) // 2])
    cut = read_recording(tmp_path)
    assert not cut.complete and 0 < len(cut.rows) < len(whole)
    write_mcap(cut, tmp_path / "mended.mcap")
    with (tmp_path / "mended.mcap").open("rb") as stream:
        counts = make_reader(stream).get_summary().statistics.channel_message_counts
    assert set(counts.values()) == {len(cut.rows)}


def test_a_decoder_of_somebody_else_finds_every_number(tmp_path):
    """By the definitions that are in the file alone, as Foxglove and the ROS tools do."""
    record(tmp_path)
    rows = read_recording(tmp_path).rows
    taken = dict.fromkeys(rows.dtype.names, 0)
    with (tmp_path / "session.mcap").open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        for _, channel, _, message in reader.iter_decoded_messages():
            topic = channel.topic.removeprefix("/")
            row = rows[topic][taken[topic]]
            taken[topic] += 1
            for name in row.dtype.names if taken[topic] % 50 == 1 else ():
                theirs = np.array(getattr(message, name)).reshape(row[name].shape)
                assert np.array_equal(theirs, row[name], equal_nan=theirs.dtype.kind == "f"), name
    assert {taken[name] for name in rows.dtype.names if rows.dtype[name].names} == {750}


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


def test_a_writer_that_stands_still_for_seconds_costs_no_tick(tmp_path):
    """4.6 s of ticks while it is stopped: a tick that waited for it would wait for ever."""
    session = make_session(world=True, realtime=True, duration_s=2.0)
    recorder = Recorder(tmp_path, make_meta(session), truth=True, progress=False)
    os.kill(recorder._process.pid, signal.SIGSTOP)
    try:
        session.backend.open()
        Loop(session, (recorder,)).run()
    finally:
        os.kill(recorder._process.pid, signal.SIGCONT)
    recorder.close()
    assert recorder.dropped == 0
    assert read_recording(tmp_path).rows["timing"]["tick"].tolist() == list(range(-450, 930))


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
