"""Parts of the command behind docs/reduced-order.md."""
