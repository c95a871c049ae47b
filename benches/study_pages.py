"""Puts the plots and sentences of `make study` into docs/accuracy.md, between the marks that are there.

Nothing of it is typed by hand: sentences are the program's own, from study/NAME/study.json.
"""

import json
import os
import re

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PAGE = os.path.join(ROOT, "docs", "accuracy.md")


def found(name):
    """The lines that belong between the marks of a study."""
    with open(os.path.join(ROOT, "study", name, "study.json"), encoding="utf-8") as file:
        study = json.load(file)
    lines = ["![Error against time](images/study-%s.png)" % name, ""]
    for line in study["lines"]:
        label = line["line"] if line["line"] == line["knob"] else line["knob"] + ", " + line["line"]
        lines.append("- **%s**: %s" % (label.replace("_", " "), line["sentence"]))
    lines += ["- **%s**: nothing to change: %s." % (out["knob"].replace("_", " "), out["reason"])
              for out in study["left_out"]]
    reference, honest = study["reference"], study["honest"]
    if reference["given"]:
        truth = "Reference: `%s`, as given." % reference["file"]
    else:
        error = "unknown" if reference["error"] is None else "%.2g %%" % (100 * reference["error"])
        truth = "Reference: %d passes in %.0f s, its own stated error %s." % (
            reference["passes"], reference["seconds"], error)
    lines += ["", "%s %d threads, %d seeds, %.0f s allowed in all.%s" % (
        truth, study["threads"], study["asked"]["seeds"], study["asked"]["seconds"],
        " The stated 95 %% interval held the true error in %d of %d renders." % (honest["held"], honest["of"])
        if honest["of"] else "")]
    lines += ["%s." % (note[0].upper() + note[1:]) for note in study["notes"]]
    if not study["complete"]:
        lines.append("The time was over before all renders were made.")
    return "\n".join(lines)


def main():
    with open(PAGE, encoding="utf-8") as file:
        page = file.read()
    marks = re.compile(r"(<!-- study (\S+) -->\n).*?(<!-- end -->)", re.DOTALL)
    page = marks.sub(lambda mark: mark[1] + found(mark[2]) + "\n" + mark[3], page)
    with open(PAGE, "w", encoding="utf-8") as file:
        file.write(page)


main()
