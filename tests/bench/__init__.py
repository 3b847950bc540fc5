"""What running, starting, stopping and showing programs costs: `python -m tests.bench`.

Figures are CPU time of the process that does the work, or ratios to it, so that a busy machine disturbs them little;
only latencies are wall time. A run is started by itself where its CPU time counts: one that the warm process forks is
no child of the bench. At least two seconds of CPU go into such a figure. What cannot be, such as a time of 0, is an
error, and the command then returns 1.

Beside each figure that depends on the machine is its ratio to something like the work, which is measured in turns with
it, see `references`. Its goal is one of the ratio, set by measuring a few times and allowing a quarter more than was
reached, at most half: a goal that is farther away is called loose and is to be set again. Most benches have a test that
plants a slow-down and sees it in every figure, see `test_bench_plants`: `python -m pytest -n 0 -m bench tests/bench`.

Needs Linux: the CPU clocks of other processes are read. To add a bench: write a function that yields figures, add a
line to `BENCHES` in `__main__`, and a slow-down to those tests.
"""
