"""Pybricks on the hubs: PrimeHub and the others, in place of the EV3. Imported for their programs only."""
