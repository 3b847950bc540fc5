"""Messages between bricks."""

from tuisim.engine.shim.pybricks.messaging import (
    BluetoothMailboxClient,
    BluetoothMailboxServer,
    LogicMailbox,
    Mailbox,
    MailboxHandlerMixIn,
    NumericMailbox,
    TextMailbox,
)
