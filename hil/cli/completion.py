"""What the shell offers for a word that is being typed."""

from pathlib import Path


def robots(incomplete: str) -> list[str]:
    """Robots that ship, and robot files below the folder that is typed."""
    from hil.robot_files import shipped_robots

    typed = Path(incomplete)
    folder = typed if incomplete.endswith("/") else typed.parent
    found = [path for path in folder.glob("*") if not path.name.startswith(".")]
    files = [str(path) for path in found if path.suffix in (".yaml", ".yml")]
    folders = [f"{path}/" for path in found if path.is_dir() and any(path.glob("*.yaml"))]
    return sorted(
        name for name in (*shipped_robots(), *files, *folders) if name.startswith(incomplete)
    )
