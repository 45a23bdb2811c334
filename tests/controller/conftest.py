import sys
from pathlib import Path

# The bench is shared by the tests of estimation and walking.
sys.path.insert(0, str(Path(__file__).parent))
