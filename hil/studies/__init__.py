"""Studies: many walks, run in parallel, whose figures make one table."""
