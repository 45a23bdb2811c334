"""The live view of a run: a process of its own that reads every tick and may die without harm."""
