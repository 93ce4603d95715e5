"""`python -m server.cli`, which is how the studio starts its own worker."""

import sys

from server.cli.main import main

sys.exit(main())
