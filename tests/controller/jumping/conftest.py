import sys
from pathlib import Path

# The robots are shared by all tests of jumping.
sys.path.insert(0, str(Path(__file__).parent))
