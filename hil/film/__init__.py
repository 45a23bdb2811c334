"""A recorded run as a film: drawn off screen, no window and no display."""
