"""What `tuisim doctor` judges of what it has found."""

from __future__ import annotations

from tests.cases import for_rows
from tuisim.commands.system import doctor
from tuisim.commands.system.doctor import Finding, FindingState, prevents_use
from tuisim.terminal.picture_options import CellSet

OK, ADVICE, PROBLEM = FindingState
TEXTUALS = (8, 2, 5), (8, 2, 8)


JUDGED: dict[str, tuple[Finding, FindingState, str]] = {
    "terminal without a kind": (
        doctor.judge_terminal("", "dumb", is_remote=False),
        ADVICE,
        "export TERM=",
    ),
    "terminal": (doctor.judge_terminal("kitty(0.40)", "xterm-kitty", is_remote=True), OK, ""),
    "no terminal": (doctor.judge_no_terminal(), ADVICE, "tuisim run"),
    "16 colours": (doctor.judge_colors("16", is_remote=False), ADVICE, "COLORTERM=truecolor"),
    "256 colours over ssh": (
        doctor.judge_colors("256", is_remote=True),
        ADVICE,
        "SSH does not send",
    ),
    "8 colours by TERM": (
        doctor.judge_colors("8", is_remote=True, is_fixed=True),
        ADVICE,
        "--colors",
    ),
    "truecolor": (doctor.judge_colors("truecolor", is_remote=False), OK, ""),
    "ascii": (doctor.judge_cells(CellSet.ASCII), ADVICE, "LANG=C.UTF-8"),
    "ascii by LC_ALL": (
        doctor.judge_cells(CellSet.ASCII, "", "LC_ALL=C"),
        ADVICE,
        "export LC_ALL=C.UTF-8",
    ),
    "ascii by TERM": (
        doctor.judge_cells(CellSet.ASCII, "dumb", "LANG=C.UTF-8"),
        ADVICE,
        "TERM=dumb",
    ),
    "quadrants": (doctor.judge_cells(CellSet.QUADRANT), OK, "Press V"),
    "octants": (doctor.judge_cells(CellSet.OCTANT), OK, ""),
    "too small": (doctor.judge_size(59, 40), ADVICE, "60 × 18"),
    "small": (doctor.judge_size(80, 23), ADVICE, "80 × 24"),
    "size": (doctor.judge_size(80, 24), OK, ""),
    "locale C": (doctor.judge_locale("LC_ALL=C", "UTF-8"), ADVICE, "export LC_ALL=C.UTF-8"),
    "locale unset": (doctor.judge_locale("", "UTF-8"), OK, ""),
    "no answer": (doctor.judge_latency(None), ADVICE, "--cells"),
    "slow": (doctor.judge_latency(0.3), ADVICE, "--fps"),
    "fast": (doctor.judge_latency(0.02), OK, ""),
    "Windows": (doctor.judge_system("Windows", "11"), PROBLEM, "WSL"),
    "macOS": (doctor.judge_system("Darwin", "23"), ADVICE, "untested"),
    "home": (doctor.home_finding("home", "cannot be written"), PROBLEM, "TUISIM_HOME"),
    "large store": (doctor.store_finding(9, 3 * 10**9, 10**12), ADVICE, "runs rm"),
    "full disk": (doctor.store_finding(0, 0, 10**6), ADVICE, "almost full"),
    "no mats": (doctor.judge_assets("no folder"), PROBLEM, "TUISIM_ASSETS"),
    "untried Textual": (
        doctor.judge_textual((8, 3, 0), TEXTUALS, []),
        ADVICE,
        "textual>=8.2.5,<=8.2.8",
    ),
    "tried Textual": (doctor.judge_textual((8, 2, 6), TEXTUALS, []), OK, ""),
    "Textual without a name": (
        doctor.judge_textual((8, 2, 6), TEXTUALS, ["App._exit"]),
        ADVICE,
        "pip",
    ),
    "package missing": (
        doctor.judge_dependencies([("numpy", "", "")])[1],
        PROBLEM,
        "Install tuisim again",
    ),
    "the old simulator": (
        doctor.judge_simulator("old.py")[0],
        ADVICE,
        "tuisim kernel install",
    ),
    "package of another version": (
        doctor.judge_dependencies([("a", "1.0", "2.0")])[1],
        PROBLEM,
        "a==1.0",
    ),
}


@for_rows("finding, state, advice", JUDGED)
def test_each_finding_of_doctor_that_is_not_ok_has_advice(
    finding: Finding, state: FindingState, advice: str
) -> None:
    assert finding.state is state
    assert advice in finding.advice
    assert bool(finding.advice) or state is OK
    assert prevents_use([finding]) is (state is PROBLEM)
