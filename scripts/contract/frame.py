"""What all pages have around their content."""
import pathlib

from .markup import escape

STYLE = (pathlib.Path(__file__).parent / "page.css").read_text()


def page(title: str, content: str, home: bool = False) -> str:
    """A whole page: one file, without addresses outside its folder."""
    path_here = "<b>Patchmill contract</b>" if home else f'<a href="index.html">Patchmill contract</a> / <b>{escape(title)}</b>'
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{escape(title)}</title>
<style>
{STYLE}</style>
</head>
<body>
<header>{path_here}</header>
<main>
{content}
</main>
</body>
</html>
"""
