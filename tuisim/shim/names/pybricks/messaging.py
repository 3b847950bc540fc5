"""Messages between bricks."""

from tuisim.shim.pybricks.messaging import (
    BluetoothMailboxClient as BluetoothMailboxClient,
)
from tuisim.shim.pybricks.messaging import (
    BluetoothMailboxServer as BluetoothMailboxServer,
)
from tuisim.shim.pybricks.messaging import (
    LogicMailbox as LogicMailbox,
)
from tuisim.shim.pybricks.messaging import (
    Mailbox as Mailbox,
)
from tuisim.shim.pybricks.messaging import (
    MailboxHandlerMixIn as MailboxHandlerMixIn,
)
from tuisim.shim.pybricks.messaging import (
    NumericMailbox as NumericMailbox,
)
from tuisim.shim.pybricks.messaging import (
    TextMailbox as TextMailbox,
)
