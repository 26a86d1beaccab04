#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Builds the documentation as one site: `./dev docs`.

  docs.py              renews generated tables and reference pages, checks links, builds the site
                       build/docs/site
  docs.py --check      changes nothing: fails when a generated page is stale or a link leads nowhere
  docs.py --pages      checks links and tables made from CSV files, for which no program is needed
  docs.py selftest

A page has a table of a CSV file beside or below it between two marks; the first row holds the
column headings:

  <!-- generated: begin; csv: fuzz/totals.csv -->
  <!-- generated: end -->

Reads README.md files and docs/ as they are, so the same pages read well on a code host and in the
site. Sphinx with MyST makes the site; the library's pages come from the headers through Doxygen
and Breathe. Every warning is an error. Reference pages need a built navvy (build/release or
build/ci) and are left alone without one.
"""
import collections
import csv
import glob
import html
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import reference  # noqa: E402

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BUILD = os.path.join(ROOT, "build", "docs")
RESULTS = "tests/validation/results.csv"
# The navigation: caption, then pages in their order. A missing page is left out; pages that are not
# listed match the patterns of the last caption.
NAVIGATION = [
    ("Start", ["README.md", "docs/getting_started.md", "docs/questions.md", "docs/glossary.md"]),
    (
        "How-to",
        [
            "docs/howto/%s.md" % name
            for name in (
                "soil",
                "machine",
                "site",
                "controller",
                "kernel_benchmark",
                "many_worlds",
                "maps",
                "library",
                "*",
            )
        ],
    ),
    (
        "Reference",
        [
            "docs/reference/scene.md",
            "docs/reference/*.md",
            "scenarios/README.md",
            "terrain/README.md",
            "src/map/README.md",
            "src/map/README.md",
        ],
    ),
    (
        "Theory",
        [
            "docs/theory.md",
            "docs/soil.md",
            "docs/tools.md",
            "docs/exchange.md",
            "docs/machines.md",
            "docs/bibliography.md",
        ],
    ),
    ("Validation", ["docs/validation_summary.md", "docs/validation.md", "bench/README.md"]),
    (
        "Development",
        [
            "CONTRIBUTING.md",
            "src/README.md",
            "kernels/README.md",
            "tests/README.md",
            "CHANGELOG.md",
            "tests/tolerances/known_deviations.md",
        ],
    ),
    ("C++ library", ["docs/api/*"]),
    ("Sources of data", ["vehicles/*/SOURCE.md", "*.md", "*/*.md", "*/*/*.md", "*/*/*/*.md"]),
]
LINK = re.compile(r"(!?)\[((?:[^\[\]`]|`[^`]*`|\[[^\]]*\])*)\]\(([^()\s]+)\)")
BEGIN = re.compile(r"^<!-- generated: begin; csv: (\S+) -->$")
END = "<!-- generated: end -->"
FENCE = re.compile(r"^(```|~~~)")
CITATION = re.compile(r"\[(docs/[\w./-]+\.md)(?:, *([^\]]*))?\](?!\()")
LITERATURE = re.compile(r"\[((?:[A-Z][\w'-]+|ISO) \d{4,5})((?:[,:;][^\[\]]*)?)\](?!\()")


def pages():
    """All pages of the repository, relative to its root."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"]
    listed = subprocess.run(
        command, cwd=ROOT, capture_output=True, text=True, check=False
    ).stdout.split("\n")
    if not any(listed):  # no clone: an archive of the sources
        listed = [
            os.path.relpath(os.path.join(folder, name), ROOT)
            for folder, _, names in os.walk(ROOT)
            for name in names
            if name.endswith(".md") and "/build" not in folder
        ]
    return sorted(path for path in set(listed) if path and os.path.exists(os.path.join(ROOT, path)))


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def slug(heading):
    """Anchor of a heading, as GitHub and MyST make it."""
    heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def prose_lines(text):
    """(number, line) of what stands outside fenced blocks, code spans blanked."""
    fenced = False
    for number, line in enumerate(text.split("\n"), 1):
        if FENCE.match(line.lstrip()):
            fenced = not fenced
        elif not fenced:
            yield number, re.sub(r"`[^`]*`", lambda span: " " * len(span[0]), line)


def anchors(text):
    found = collections.Counter()
    out, fenced = set(), False
    for line in text.split("\n"):
        if FENCE.match(line.lstrip()):
            fenced = not fenced
        if fenced:
            continue
        heading = re.match(r"^#+ +(.*?)\s*$", line)
        if heading:
            name = slug(heading[1])
            out.add(name + ("-%d" % found[name] if found[name] else ""))
            found[name] += 1
    return out


def unpaired(text):
    """The text with links that wrap over a line's end on one line, for the search alone."""
    return re.sub(r"\]\(\s*\n\s*", "](", text)


def wrong_links(all_pages):
    texts = {page: read(page) for page in all_pages}
    places = {page: anchors(text) for page, text in texts.items()}
    wrong = []
    for page, text in texts.items():
        for number, line in prose_lines(unpaired(text)):
            for _, _, target in LINK.findall(line):
                if re.match(r"^\w+:", target):
                    continue
                path, _, anchor = target.partition("#")
                path = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
                if not os.path.exists(os.path.join(ROOT, path)):
                    wrong.append("%s:%d: no file %s" % (page, number, target))
                elif anchor and path in places and anchor not in places[path]:
                    wrong.append("%s:%d: no heading for %s" % (page, number, target))
    return wrong


def long_entries(changelog):
    """Entries of the changelog that are not one line of at most 160 characters."""
    wrong = []
    for number, line in enumerate(changelog.split("\n"), 1):
        if line.startswith("- ") and len(line) > 162:
            wrong.append(
                "CHANGELOG.md:%d: an entry has at most 160 characters, not %d"
                % (number, len(line) - 2)
            )
        elif line.startswith("  "):
            wrong.append("CHANGELOG.md:%d: an entry is one line" % number)
    return wrong


def csv_table(path):
    """Markdown of a CSV file."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = [
            [cell.replace("|", "\\|").replace("*_", "\\*_") for cell in row]
            for row in csv.reader(file)
        ]
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    return lines[:1] + ["|" + "---|" * len(rows[0])] + lines[1:]


def with_csv_tables(text, folder):
    """The page with its CSV tables made anew."""
    out, inside = [], False
    for line in text.split("\n"):
        begin = BEGIN.match(line)
        if not inside:
            out.append(line)
        if begin:
            out += csv_table(os.path.join(folder, begin[1]))
            inside = True
        elif inside and line == END:
            out.append(line)
            inside = False
    return "\n".join(out)


def csv_tables(all_pages, only_check):
    good = True
    for page in all_pages:
        before = read(page)
        after = with_csv_tables(before, os.path.join(ROOT, os.path.dirname(page)))
        if before == after:
            continue
        if only_check:
            good = False
            print(
                "%s: a table is not what its CSV file gives: `./dev docs` writes it" % page,
                file=sys.stderr,
            )
        else:
            write(os.path.join(ROOT, page), after)
    return good


# --- the site


def staged(page, text, all_pages):
    """A page as Sphinx reads it: links to other files become text, citations become links."""
    here = os.path.dirname(page)

    def link(found):
        image, label, target = found[1], found[2], found[3]
        if image or re.match(r"^(\w+:|#)", target):
            return found[0]
        path = os.path.normpath(os.path.join(here, target.partition("#")[0]))
        if path in all_pages:
            return found[0]
        return "%s (`%s`)" % (label, path) if label.strip("`") != path else "`%s`" % path

    def citation(found):
        path, heading = found[1], found[2]
        if path not in all_pages:
            return found[0]
        target = os.path.relpath(path, here or ".")
        name = os.path.basename(path)[:-3]
        if heading:
            return "[%s, %s](%s#%s)" % (name, heading, target, slug(heading))
        return "[%s](%s)" % (name, target)

    def literature(found):
        if page == "docs/bibliography.md":
            return found[0]
        return "[\\[%s%s\\]](%s)" % (
            found[1],
            found[2],
            os.path.relpath("docs/bibliography.md", here or "."),
        )

    out, fenced = [], False
    for line in text.split("\n"):
        if FENCE.match(line.lstrip()):
            fenced = not fenced
        if not fenced:
            parts = re.split(r"(`[^`]*`)", line)
            if not any("](" in part for part in parts[1::2]):
                for i in range(0, len(parts), 2):
                    parts[i] = LITERATURE.sub(literature, CITATION.sub(citation, parts[i]))
                line = "".join(parts)
            line = LINK.sub(link, line)
        out.append(line)
    return "\n".join(out)


def toctree(all_pages, api):
    """The navigation as hidden toctrees."""
    left, out = [page for page in all_pages + api if page != "docs/README.md"], []
    for caption, patterns in NAVIGATION:
        entries = []
        for pattern in patterns:
            some = [
                p
                for p in left
                if re.fullmatch(pattern.replace(".", r"\.").replace("*", "[^/]*"), p)
            ]
            entries += some
            left = [p for p in left if p not in some]
        if entries:
            out += ["```{toctree}", ":hidden:", ":maxdepth: 2", ":caption: " + caption, ""]
            out += ["/" + re.sub(r"\.\w+$", "", entry) for entry in entries] + ["```", ""]
    if left:
        sys.exit("docs.py: not in the navigation: %s" % ", ".join(left))
    return "\n".join(out)


def run(*command, **more):
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, **more)
    if done.returncode != 0:
        sys.stderr.write(done.stdout + done.stderr)
        sys.exit("docs.py: %s failed" % os.path.basename(command[0]))
    return done.stdout + done.stderr


def sphinx_python():
    """Returns a Python that has Sphinx: this one, or Debian's."""
    for python in (sys.executable, "/usr/bin/python3"):
        done = subprocess.run(
            [python, "-c", "import sphinx, myst_parser, breathe, sphinx_rtd_theme"],
            capture_output=True,
            check=False,
        )
        if done.returncode == 0:
            return python
    sys.exit(
        "docs.py: Sphinx is missing: apt-get install python3-sphinx python3-myst-parser "
        "python3-breathe "
        "python3-sphinx-rtd-theme doxygen"
    )


def doxygen():
    """XML of the headers. Comments name elements of scene files, which are no tags of Doxygen's."""
    folder = os.path.join(BUILD, "doxygen")
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    settings = (
        read("docs/site/Doxyfile")
        + "\n".join(
            [
                "INPUT = src",
                "RECURSIVE = YES",
                "FILE_PATTERNS = *.h",
                "OUTPUT_DIRECTORY = " + folder,
                "INPUT_FILTER = \"sed -E '/^ *\\/\\/\\//s/<([\\/A-Za-z])/\\&lt;\\1/g; "
                "s/@throws/Throws/g'\"",
            ]
        )
        + "\n"
    )
    path = os.path.join(folder, "Doxyfile")
    with open(path, "w", encoding="utf-8") as file:
        file.write(settings)
    run("doxygen", path)
    return os.path.join(folder, "xml")


def declared(folder):
    """Returns what each header declares: {header: [(kind, qualified name, element)]}."""
    out = collections.defaultdict(list)
    for path in sorted(glob.glob(os.path.join(folder, "*.xml"))):
        name = os.path.basename(path)
        if not name.startswith(("class", "struct", "namespace")):
            continue
        for compound in xml.etree.ElementTree.parse(path).getroot().iter("compounddef"):
            full = compound.findtext("compoundname") or ""
            if "anonymous" in full or "@" in full or "detail" in full.split("::"):
                continue
            if compound.get("kind") in ("class", "struct"):
                place = compound.find("location")
                parent = full.rpartition("::")[0]
                nested = glob.glob(
                    os.path.join(
                        folder, "*" + parent.replace("_", "__").replace("::", "_1_1") + ".xml"
                    )
                )
                inner = any(os.path.basename(n).startswith(("class", "struct")) for n in nested)
                if place is not None and not inner and "<" not in full:
                    out[place.get("file")].append((compound.get("kind"), full, compound))
            else:
                for member in compound.iter("memberdef"):
                    place = member.find("location")
                    if member.get("kind") in ("function", "enum", "typedef") and place is not None:
                        name = full + "::" + (member.findtext("name") or "")
                        out[place.get("file")].append((member.get("kind"), name, member))
    return out


def text_of(element):
    return " ".join("".join(element.itertext()).split()) if element is not None else ""


def escaped(text):
    """Plain text for a page of reStructuredText."""
    return re.sub(r"([\\`*|_])", r"\\\1", text)


def api_pages(folder):
    """One page of reStructuredText for each module of src/ with public headers: {path: text}."""
    found, out = declared(folder), {}
    # Overloads may be declared in several headers.
    counts = collections.Counter(
        name for things in found.values() for kind, name, _ in things if kind == "function"
    )
    modules = collections.defaultdict(list)
    for header in sorted(found):
        relative = (
            header.partition("src/")[2] if header.startswith("/") else re.sub(r"^src/", "", header)
        )
        if relative.count("/") == 1:
            modules[relative.partition("/")[0]].append((relative, found[header]))
    for module, headers in modules.items():
        lines = [module, "=" * len(module), ""]
        for header, things in headers:
            lines += [header, "-" * len(header), ""]
            for kind, name, element in things:
                if kind in ("class", "struct"):
                    lines += [".. doxygen%s:: %s" % (kind, name), "   :members:", ""]
                elif kind == "function" and (counts[name] > 1 or "operator" in name):
                    # Overloads as text: Breathe does not find all of them by their arguments.
                    declaration = "%s %s%s" % (
                        text_of(element.find("type")),
                        name,
                        element.findtext("argsstring") or "",
                    )
                    lines += [
                        "``%s``" % html.unescape(declaration.strip()),
                        "",
                        "   "
                        + escaped(text_of(element.find("briefdescription")) or "See the header."),
                        "",
                    ]
                elif kind in ("function", "enum", "typedef"):
                    lines += [".. doxygen%s:: %s" % (kind, name), ""]
        out["docs/api/%s.rst" % module] = "\n".join(lines) + "\n"
    return out


def build_site(all_pages):
    source, site = os.path.join(BUILD, "source"), os.path.join(BUILD, "site")
    for folder in (
        source,
        site,
        os.path.join(BUILD, "doctrees"),
    ):  # Breathe trips over headers that are gone
        shutil.rmtree(folder, ignore_errors=True)
    folder = doxygen()
    api = api_pages(folder)
    for page in all_pages:
        text = staged(page, read(page), all_pages)
        if page == "docs/README.md":
            text += "\n" + toctree(all_pages, sorted(api))
        write(os.path.join(source, page), text)
    for path, text in api.items():
        write(os.path.join(source, path), text)
    for page in all_pages:
        for image, _, target in LINK.findall(read(page)):
            path = os.path.normpath(os.path.join(os.path.dirname(page), target))
            if image and os.path.exists(os.path.join(ROOT, path)):
                os.makedirs(os.path.dirname(os.path.join(source, path)), exist_ok=True)
                shutil.copy(os.path.join(ROOT, path), os.path.join(source, path))
    shutil.copy(os.path.join(ROOT, "docs/site/conf.py"), source)
    shutil.copytree(os.path.join(ROOT, "docs/site/static"), os.path.join(source, "static"))
    version = re.search(r"project\(navvy VERSION ([\d.]+)", read("CMakeLists.txt"))
    environment = dict(
        os.environ, NAVVY_DOCS_XML=folder, NAVVY_DOCS_VERSION=version[1] if version else ""
    )
    run(
        sphinx_python(),
        "-m",
        "sphinx",
        "-q",
        "-W",
        "--keep-going",
        "-b",
        "html",
        "-d",
        os.path.join(BUILD, "doctrees"),
        source,
        site,
        env=environment,
    )
    write(
        os.path.join(site, "index.html"),
        '<!doctype html><meta charset="utf-8">'
        '<meta http-equiv="refresh" content="0; url=docs/README.html">'
        '<title>Navvy</title><a href="docs/README.html">Navvy</a>\n',
    )
    return site


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def generated(only_check):
    """Writes tables and reference pages, or lists the stale ones. Returns True if all are good."""

    def table(script, *arguments):
        done = subprocess.run([sys.executable, script] + list(arguments), cwd=ROOT, check=False)
        return done.returncode == 0

    tests, bench = "tests/validation/table.py", "bench/table.py"
    good = table(tests, "check" if only_check else "write", RESULTS, "docs/validation.md")
    good &= table(
        tests, "check-summary" if only_check else "summary", RESULTS, "docs/validation_summary.md"
    )
    good &= table(bench, "check" if only_check else "write", "bench/README.md")
    built = [
        p
        for p in ("build/release", "build/ci")
        if os.path.exists(os.path.join(ROOT, p, "src/cli/navvy"))
    ]
    if built:
        good &= reference.write(reference.find_program(), only_check)
    else:
        print("docs: no navvy is built, reference pages are left as they are")
    return good


def selftest():
    assert slug("Keys of summary.json") == "keys-of-summaryjson"
    assert slug("In a machine's `model`") == "in-a-machines-model"
    assert anchors("# A b\n```\n# no\n```\n## A b\n") == {"a-b", "a-b-1"}
    pages_here = ["docs/soil.md", "docs/bibliography.md", "README.md"]
    text = staged(
        "README.md",
        "[docs/soil.md, yield] and [Klar 2016]; [code](src/x.h), `[docs/soil.md]`",
        pages_here,
    )
    assert (
        text == "[soil, yield](docs/soil.md#yield) and [\\[Klar 2016\\]](docs/bibliography.md); "
        "code (`src/x.h`), "
        "`[docs/soil.md]`"
    ), text


def main(arguments=None):
    arguments = sys.argv[1:] if arguments is None else arguments
    if any(argument not in ("--check", "--pages", "selftest") for argument in arguments):
        sys.exit(__doc__)
    if "selftest" in arguments:
        selftest()
        return 0
    all_pages = pages()
    good = csv_tables(all_pages, bool(arguments))
    good &= "--pages" in arguments or generated("--check" in arguments)
    wrong = wrong_links(all_pages) + long_entries(read("CHANGELOG.md"))
    for line in wrong:
        print(line, file=sys.stderr)
    if wrong or not good:
        return 1
    print("docs: %d pages, every link leads somewhere" % len(all_pages))
    if not arguments:
        site = build_site(all_pages)
        print("docs: the site is %s" % os.path.relpath(os.path.join(site, "index.html"), ROOT))
    return 0


if __name__ == "__main__":
    sys.exit(main())
