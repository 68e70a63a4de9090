from __future__ import annotations

import os
import re
import signal
import socket
import subprocess
import sys
import time
import urllib.request

import pytest

from tests.cli.conftest import COEFLAB


@pytest.fixture
def serving(tmp_path):
    """A gallery as a process; the address is the first thing it says."""
    started = []

    def start(*arguments: str, **environment: str) -> tuple[subprocess.Popen[str], str]:
        command = [str(COEFLAB), "serve", str(tmp_path), "--port", "0", *arguments]
        process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=os.environ | environment
        )
        started.append(process)
        said = process.stdout.readline()
        return process, re.search(r"http://127\.0\.0\.1:\d+/", said)[0]

    yield start
    for process in started:
        process.kill()
        process.communicate()


@pytest.mark.skipif(sys.platform == "win32", reason="Ctrl-C is another thing there")
def test_ctrl_c_ends_it_quietly(serving):
    process, address = serving()
    with urllib.request.urlopen(address, timeout=10) as answer:
        assert b"coeflab report suboff" in answer.read()
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=10)
    assert process.returncode == 0
    assert (out.strip(), err) == ("", "")


def test_a_port_in_use_is_one_clear_error(coeflab, tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        done = coeflab("serve", tmp_path, "--port", str(taken.getsockname()[1]))
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.strip().splitlines()) == 1
    assert "--port" in done.stderr


@pytest.mark.parametrize("arguments", [("nowhere",), (".", "--port", "70000"), (".", "--port", "-1"), ()])
def test_what_cannot_be_served_is_said(coeflab, arguments):
    done = coeflab("serve", *arguments)
    assert done.returncode == 2
    assert done.stderr
    assert "Traceback" not in done.stderr


def test_open_hands_the_address_to_the_browser(serving, tmp_path):
    browser, shown = tmp_path / "browser", tmp_path / "shown"
    browser.write_text(f'#!/bin/sh\necho "$1" > {shown}\n')
    browser.chmod(0o755)
    _, address = serving("--open", BROWSER=f"{browser} %s")
    until = time.monotonic() + 10.0
    while not (shown.exists() and shown.read_text().strip()) and time.monotonic() < until:
        time.sleep(0.02)
    assert shown.read_text().strip() == address
