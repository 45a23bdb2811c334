"""A recording in other formats, by the command."""

import subprocess
import sys

from mcap.reader import make_reader
from typer.testing import CliRunner

from hil.cli.main import app
from hil.recording import read_recording


def stride(*arguments):
    return CliRunner().invoke(app, ["export", *map(str, arguments)])


def test_csv_is_what_it_is_called(short_walk):
    named, flagged = stride(short_walk, "--format", "csv"), stride(short_walk, "--csv")
    assert flagged.exit_code == 0 and flagged.stdout == named.stdout
    assert stride(short_walk, "--csv", "--format", "jsonl").exit_code == 2


def test_a_cut_recording_is_mended(short_walk, tmp_path):
    data = (short_walk / "session.mcap").read_bytes()
    (tmp_path / "session.mcap").write_bytes(data[: len(data) // 2])
    assert stride(tmp_path, "--format", "mcap").exit_code == 2
    assert stride(tmp_path, "--format", "mcap", "--out", tmp_path / "whole.mcap").exit_code == 0
    with (tmp_path / "whole.mcap").open("rb") as stream:
        statistics = make_reader(stream).get_summary().statistics
    kept = len(read_recording(tmp_path).rows)
    assert 0 < kept < len(read_recording(short_walk).rows)
    assert set(statistics.channel_message_counts.values()) == {kept}


def test_a_reader_that_has_enough_is_no_error(short_walk):
    program = "from hil.cli.main import main; main()"
    command = [sys.executable, "-c", program, "export", str(short_walk), "--csv"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout.readline().startswith(b"time_ns,time_s,")
        process.stdout.close()
        assert process.stderr.read() == b""
        assert process.wait() == 0
