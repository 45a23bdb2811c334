"""The offline search of the studies: CMA-ES over walks, in parallel, kept across interruptions."""
