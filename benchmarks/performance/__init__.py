"""What the commands behind docs/performance.md have in common."""
