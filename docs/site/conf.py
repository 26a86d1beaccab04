# SPDX-License-Identifier: Apache-2.0
# Sphinx reads the pages that tools/docs.py has copied beside this file (`./dev docs`).
import os

project = "Navvy"
copyright = "the Navvy authors, Apache-2.0"
version = release = os.environ.get("NAVVY_DOCS_VERSION", "")
extensions = ["myst_parser", "breathe"]
root_doc = "docs/README"
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
exclude_patterns = ["out"]
myst_heading_anchors = 4
breathe_projects = {"navvy": os.environ.get("NAVVY_DOCS_XML", "xml")}
breathe_default_project = "navvy"
breathe_domain_by_extension = {"h": "cpp"}
highlight_language = "none"
html_theme = "sphinx_rtd_theme"
html_theme_options = {"navigation_depth": 3, "collapse_navigation": True}
html_static_path = ["static"]
html_css_files = ["navvy.css"]
html_show_sourcelink = False
html_copy_source = False
