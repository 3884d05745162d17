#!/usr/bin/env python3
"""The pages of the project as a static site with search, which opens without network; a link that leads nowhere fails:

  python3 tests/static_site.py [OUT] [REFERENCE]     build/site; REFERENCE: the HTML pages of the headers, which go into OUT/headers

Needs the Debian package mkdocs. Every page is there as it stands, with the files that it links; a folder without a page gets a list of its files."""
import html.parser
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

top = pathlib.Path(__file__).resolve().parent.parent
skipped = {"build", "output", "_CPack_Packages"}
menu = [("Isostat", "README.md"), ("Scenes", "src/scene/README.md"), ("Files", "src/io/README.md"), ("Examples", "examples/README.md"),
        ("Python", "src/python/README.md"), ("C++", "include/README.md"), ("Faster codes", "src/compare/README.md"),
        ("Proofs", "proofs/README.md"), ("Costs", "tests/bench/README.md"), ("Add to it", "CONTRIBUTING.md"), ("Changes", "CHANGELOG.md")]
link = re.compile(r"(\]\()([^)\s]+)(\))")


def slugify(value, separator="-"):
    """Names of headings as the pages' links have them."""
    return "".join(separator if c == " " else c for c in value.lower().strip() if c.isalnum() or c in " -_")


def pages():
    for path in sorted(top.rglob("*.md")):
        parts = path.relative_to(top).parts
        if not any(part in skipped or part.startswith(".") for part in parts):
            yield path


def listing(folder):
    files = [path.name for path in sorted(folder.iterdir()) if path.is_file()]
    return f"# {folder.relative_to(top)}\n\n" + "".join(f"- [{name}]({name})\n" for name in files), files


def nested(text):
    """Blocks inside of a list set in by four blanks, and code there by eight, as Python's Markdown asks for."""
    inside, code, fenced, lines = False, False, False, []
    for line in text.split("\n"):
        if line.startswith("```"):
            code = not code
        if inside and line.strip().startswith("```"):
            fenced = not fenced
            continue
        if fenced:
            lines.append("      " + line)
            continue
        if not code and re.match(r"(- |\d+\. )", line):
            inside = True
        elif line and not line.startswith("  "):
            inside = False
        lines.append("  " + line if inside and line.startswith("  ") else line)
    return "\n".join(lines)


def stage(folder):
    """The pages, and what they link, below `folder`."""
    def copy(path):
        to = folder / path.relative_to(top)
        if not to.exists():
            to.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, to)

    for page in pages():
        def put(match, page=page):
            target = match[2]
            if "://" in target or target.startswith(("#", "mailto:")):
                return match[0]
            name, mark, anchor = urllib.parse.unquote(target).partition("#")
            path = (page.parent / name).resolve()
            if not path.exists() or not path.is_relative_to(top):
                return match[0]  # the check of the links says so
            if path.is_dir():
                if not (path / "README.md").is_file():
                    text, files = listing(path)
                    for file in files:
                        copy(path / file)
                    (folder / path.relative_to(top) / "README.md").write_text(text)
                return f"{match[1]}{name.rstrip('/')}/README.md{mark}{anchor}{match[3]}"
            if path.suffix != ".md":
                copy(path)
            return match[0]

        to = folder / page.relative_to(top)
        to.parent.mkdir(parents=True, exist_ok=True)
        to.write_text(nested(link.sub(put, page.read_text())))


def build(pages_folder, out):
    extensions = f"""markdown_extensions:
  - tables
  - fenced_code
  - toc:
      slugify: !!python/name:{pathlib.Path(__file__).stem}.slugify
"""
    config = pages_folder.parent / "mkdocs.yml"
    nav = "".join(f"  - {title!r}: {page}\n" for title, page in menu)
    config.write_text(f"site_name: Isostat\ndocs_dir: {pages_folder}\nsite_dir: {out}\nuse_directory_urls: false\n"
                      f"theme:\n  name: mkdocs\n  highlightjs: false\nplugins:\n  - search\n{extensions}nav:\n{nav}")
    environment = {**os.environ, "PYTHONPATH": str(pathlib.Path(__file__).parent), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(["mkdocs", "build", "--quiet", "--clean", "-f", config], env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stdout + done.stderr)


class Links(html.parser.HTMLParser):
    """Targets and anchors of a page."""

    def __init__(self, text):
        super().__init__()
        self.targets, self.anchors = [], {""}
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("href", "src") and value is not None and (tag, value) != ("a", "."):
                self.targets.append(value)
            elif name == "id" or (tag == "a" and name == "name"):
                self.anchors.add(value)


def dead_links(out):
    """Links of the pages below `out` that lead nowhere, or to another computer where the page loads something from there."""
    files = [path for path in out.rglob("*.html") if path.name != "404.html"]
    parsed = {path.resolve(): Links(path.read_text()) for path in files}
    for path, links in parsed.items():
        for target in links.targets:
            parts = urllib.parse.urlsplit(target)
            if parts.scheme or parts.netloc or target.startswith("javascript:"):
                continue
            there = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            there = there / "index.html" if there.is_dir() else there
            anchor = urllib.parse.unquote(parts.fragment)
            if anchor == "nested-classes":
                continue  # Doxygen 1.9.4 links it where it leaves it out
            if not there.is_file() or (there in parsed and anchor and anchor not in parsed[there].anchors):
                yield f"{path.relative_to(out.resolve())}: {target}"


def main():
    out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else top / "build/site").resolve()
    if out.exists() and not (out / "search/search_index.json").is_file():
        sys.exit(f"{out}: expected a new name, or a site that was made before")
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch) / "pages"
        stage(folder)
        build(folder, out)
    if len(sys.argv) > 2:
        shutil.copytree(sys.argv[2], out / "headers")
    dead = sorted(set(dead_links(out)))
    if dead:
        sys.exit("links that lead nowhere:\n" + "\n".join(dead))
    print(f"{out / 'index.html'}: {len(list(out.rglob('*.html')))} pages")


if __name__ == "__main__":
    main()
