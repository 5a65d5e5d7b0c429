"""`python -m mdlgen`."""

from mdlgen.cli import main

if __name__ == "__main__":
    main()
