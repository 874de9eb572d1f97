"""Pictures of finished runs as a page of the documentation site.

    site_gallery.py RUNS SCENE...     RUNS/<name of scene> are results folders, which the site has as live/<name>
"""

import json
import sys
import xml.etree.ElementTree
from pathlib import Path

print("# Gallery\n\nPictures of finished runs. Each report is a page by itself, as `annulus run` writes it.")
for run in (Path(sys.argv[1]) / Path(scene).stem for scene in sys.argv[2:]):
    summary = json.loads((run / "summary.json").read_text(encoding="utf-8"))
    print(f"\n## {summary['title']}\n\n[The whole report](live/{run.name}/report.html)\n")
    shown = set()
    for picture in sorted(run.glob("pictures/*.svg")):
        section = picture.stem.split("_")[1]  # NN_<section>_<title>
        if section in shown:
            continue
        shown.add(section)
        label = xml.etree.ElementTree.parse(picture).getroot().get("aria-label", picture.stem)
        print(f"![{label}](live/{run.name}/pictures/{picture.name})\n")
