"""Reports of a run: its page, pictures, text and exports."""

PAGE = "report.html"  # of a run, in its folder
