"""What running, starting, stopping and showing programs costs: `python -m tests.bench`.

Every figure is CPU time or a ratio to it, so that a busy machine disturbs it little; only latencies are wall time.
Beside each figure that depends on the machine is its ratio to a reference that is measured in the same run, see
`references`; its goal is one of the ratio. Needs Linux: the CPU clocks of other processes are read.
To add a bench: write a function that yields figures, and add a line to `BENCHES` in `__main__`.
"""
