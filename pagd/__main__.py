"""``python -m pagd`` is ``pagd``."""

import sys

from pagd.cli import main

sys.exit(main())
