"""Mailboxes: what they send, and how two ends in one program talk."""

from __future__ import annotations

from typing import Any

import pytest

from tests.engine.shim.conftest import RunOn
from tuisim.engine.shim.pybricks.messaging import (
    LogicMailbox,
    Mailbox,
    MailboxHandlerMixIn,
    NumericMailbox,
    TextMailbox,
)

PROFILE = "lego-micropython"


@pytest.mark.parametrize(
    "kind, value, payload",
    [
        (LogicMailbox, True, b"\x01"),
        (LogicMailbox, False, b"\x00"),
        (NumericMailbox, 1.5, b"\x00\x00\xc0\x3f"),
        (NumericMailbox, -2, b"\x00\x00\x00\xc0"),
        (TextMailbox, "Grün", b"Gr\xc3\xbcn\x00"),
        (TextMailbox, "", b"\x00"),
    ],
)
def test_a_mailbox_encodes_a_value_to_bytes_and_back(
    kind: type[Mailbox], value: Any, payload: bytes
) -> None:
    box = kind("box", MailboxHandlerMixIn())
    assert box.encode(value) == payload
    assert box.decode(payload) == value


def test_a_mailbox_converts_values_with_functions_of_the_program() -> None:
    box = Mailbox(
        "box",
        MailboxHandlerMixIn(),
        encode=lambda value: value + 1,
        decode=lambda payload: payload * 2,
    )
    assert (box.encode(1), box.decode(1)) == (2, 2)


TALK = """
import threading
from pybricks.messaging import *
from pybricks.tools import wait

server, client = BluetoothMailboxServer(), BluetoothMailboxClient()

def other():
    wait(500)
    client.connect('brick')
    order, answer = TextMailbox('order', client), NumericMailbox('answer', client)
    order.wait()
    print('got', order.read())
    for number in (0, 0, 7):
        wait(100)
        answer.send(number, 'brick')

threading.Thread(target=other).start()
server.wait_for_connection()
order, answer = TextMailbox('order', server), NumericMailbox('answer', server)
print(answer.read())
wait(100)
order.send('go')
answer.wait()
print(answer.read(), answer.wait_new())
try:
    order.send('go', 'elsewhere')
except ValueError as error:
    print(error)
client.close()
order.send('nobody hears it')
"""


def test_a_mailbox_server_and_client_in_one_program_exchange_messages(run_on: RunOn) -> None:
    done = run_on(TALK, profile=PROFILE)
    unknown = 'no paired devices matching "elsewhere"'
    assert done.lines == ["None", "got go", "0.0 7.0", unknown], done.errors


@pytest.mark.parametrize(
    "call, told",
    [
        ("BluetoothMailboxServer().wait_for_connection()", "no other brick is simulated"),
        ("BluetoothMailboxClient().connect('left')", "'left' is not simulated"),
    ],
)
def test_connecting_a_mailbox_to_another_brick_is_refused(
    run_on: RunOn, call: str, told: str
) -> None:
    done = run_on(f"from pybricks.messaging import *\n{call}", profile=PROFILE)
    assert done.ended.summary.startswith("NotSimulated: BluetoothMailbox")
    assert told in done.ended.summary
