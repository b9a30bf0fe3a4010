"""`python -m foveal`: the command line, for where scripts are not on the path."""

from foveal.cli.main import run

if __name__ == "__main__":
    run()
