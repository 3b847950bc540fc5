"""Messages between bricks."""

from tuisim.engine.shim.pybricks.messaging import (
    BluetoothMailboxClient as BluetoothMailboxClient,
)
from tuisim.engine.shim.pybricks.messaging import (
    BluetoothMailboxServer as BluetoothMailboxServer,
)
from tuisim.engine.shim.pybricks.messaging import (
    LogicMailbox as LogicMailbox,
)
from tuisim.engine.shim.pybricks.messaging import (
    Mailbox as Mailbox,
)
from tuisim.engine.shim.pybricks.messaging import (
    MailboxHandlerMixIn as MailboxHandlerMixIn,
)
from tuisim.engine.shim.pybricks.messaging import (
    NumericMailbox as NumericMailbox,
)
from tuisim.engine.shim.pybricks.messaging import (
    TextMailbox as TextMailbox,
)
