import sys
from pathlib import Path

# Worker processes import the fakes by name: they get this process's sys.path.
sys.path.insert(0, str(Path(__file__).parent))
