"""Renders the gallery and writes its page.

    benches/gallery.py [--draft] [--again] [--passes N] [NAME...]

Every scene of scenes/gallery/ and scenes/terrarium.ron is rendered to renders/gallery/, and the page is
docs/gallery.md. The first comment line of a scene is its caption. A line of that comment

    picture NAME: OPTIONS "CAPTION"

asks for a further picture of the scene with options of `terrarium render`; `--layer LAYER` shows a
layer instead of the picture, and is rendered with one pass. `picture: OPTIONS` gives the scene's own picture
options. What a picture was made of, and what its
render said, is kept in renders/gallery/pictures.json; only pictures whose scene, meshes, textures or
options have changed since are rendered again, or all with --again. With --draft everything is rendered
at half the size with an eighth of the passes to renders/draft/, always, and no page is written. With
names of scenes or pictures only those are rendered. --passes N takes N passes at most, until the next run without it.
"""

import hashlib
import json
import os
import re
import resource
import shlex
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from layers import write_layer  # noqa: E402
from measure import ROOT, TERRARIUM  # noqa: E402

# In the page's order, with its headings.
CHAPTERS = [
    ("The terrarium", ["terrarium"]),
    ("Mirrors and glass", ["reflection", "reflection_shapes", "refraction", "tumbler"]),
    ("Shapes and surfaces", ["primitives", "textures", "normal_maps", "smooth_shading"]),
    ("Shadows and edges", ["shadows", "soft_shadows", "antialiasing"]),
    ("Caustics", ["caustic", "ring", "pool", "magnifier", "wine", "prism"]),
    ("Light from all around", ["cornell", "still_life", "depth_of_field"]),
]
WIDTH = 800
LARGEST = 640_000


class Picture:
    """A picture of a scene, and the options that make it."""

    def __init__(self, scene, name, caption, options):
        self.scene, self.name, self.caption = scene, name, caption
        words = shlex.split(options)
        self.layer = None
        if "--layer" in words:
            at = words.index("--layer")
            self.layer = words[at + 1]
            del words[at:at + 2]
        self.options = words


def scene_file(stem):
    found = [os.path.join(folder, stem + ending) for folder in ("scenes/gallery", "scenes")
             for ending in (".ron", ".toml")]
    return next(file for file in found if os.path.exists(os.path.join(ROOT, file)))


def read(stem):
    """The pictures of a scene, and its width and height."""
    file = scene_file(stem)
    with open(os.path.join(ROOT, file), encoding="utf-8") as text:
        lines = text.read().split("\n")
    comment = []
    for line in lines:
        if not line.startswith(("//", "#")):
            break
        comment.append(line.lstrip("/#").strip())
    own = next((line.split(":", 1)[1].strip() for line in comment if line.startswith("picture:")), "")
    pictures = [Picture(file, stem, comment[0], own)]
    for line in comment:
        found = re.fullmatch(r'picture (\w+): (.*) "(.*)"', line)
        if found:
            pictures.append(Picture(file, found[1], found[3], found[2]))
    size = [int(re.search(side + r"\s*[:=]\s*(\d+)", "\n".join(lines))[1]) for side in ("width", "height")]
    return pictures, size


def sha(file):
    with open(os.path.join(ROOT, file), "rb") as content:
        return hashlib.sha256(content.read()).hexdigest()


def dependencies(depfile):
    """The files that a rule of make names, relative to the project."""
    with open(depfile, encoding="utf-8") as text:
        rule = text.read().replace("\\\n", " ").split("\n")[0]
    names = re.split(r"(?<!\\)\s+", rule.split(": ", 1)[1].strip())
    absolute = [os.path.join(ROOT, name.replace("\\ ", " ")) for name in names]
    return sorted({os.path.relpath(os.path.realpath(name), os.path.realpath(ROOT)) for name in absolute})


def smaller(size, draft):
    """Options for the size, and for a draft's passes."""
    factor = min(1, WIDTH / size[0]) * (0.5 if draft else 1)
    width, height = (round(side * factor) for side in size)
    return [] if factor == 1 else ["--set", f"image.width={width}", "--set", f"image.height={height}"]


def fewer_passes(picture, draft, most):
    """Options for an eighth of the picture's passes, or for `most`; none where it asks for no number."""
    with open(os.path.join(ROOT, picture.scene), encoding="utf-8") as text:
        own = re.search(r"passes\s*[:=]\s*(\d+)", text.read())
    # Where an error is asked for, passes are only the most that it may take.
    bound = draft and "--error" in picture.options
    asked = (None if bound else re.search(r"--passes (\d+)", " ".join(picture.options))) or own
    if not asked or not (draft or most):
        return []
    return ["--passes", str(max(4, int(asked[1]) // 8) if draft else min(most, int(asked[1])))]


def without_error(options):
    """A draft has its passes, whatever error they leave."""
    return [word for at, word in enumerate(options) if word != "--error" and (not at or options[at - 1] != "--error")]


def render(picture, options, out):
    """Renders a picture to `out`; returns the render's statistics and the files it has read."""
    with tempfile.TemporaryDirectory() as folder:
        stats, rule = (os.path.join(folder, name) for name in ("stats.json", "rule.d"))
        image = os.path.join(folder, "image.exr") if picture.layer else out
        layer = ["--aov", picture.layer] if picture.layer else []
        subprocess.run([TERRARIUM, "render", picture.scene, "-o", image, "--stats", stats, "--depfile", rule,
                        "--progress", "none", "--quiet", *options, *layer], cwd=ROOT, check=True)
        if picture.layer:
            write_layer(image, picture.layer, out)
        with open(stats, encoding="utf-8") as text:
            return json.load(text), dependencies(rule)


def load(book):
    """What is kept of the pictures; another run may be adding to it."""
    if not os.path.exists(book):
        return {}
    with open(book, encoding="utf-8") as text:
        return json.load(text)


def processor_seconds():
    """Of the renders so far: they take the same however busy the machine is."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def told(seconds):
    return f"{seconds:.1f} s" if seconds < 10 else f"{seconds:.0f} s"


def line(picture, kept):
    """What the page says below a picture."""
    where = f"[{picture.scene}](../{picture.scene})"
    words = picture.options + (["--aov", picture.layer] if picture.layer else [])
    while "--passes" in words:
        del words[words.index("--passes"):words.index("--passes") + 2]
    options = " ".join(f"'{word}'" if re.search(r"[()]", word) else word for word in words)
    error = kept["error"]
    accuracy = "" if error is None else f", stated error {100 * error:.2g} %"
    return f"{where}{' with `' + options + '`' if options else ''}: {told(kept['processor_seconds'])}, " \
           f"{kept['passes']} pass{'es' if kept['passes'] > 1 else ''}{accuracy}"


def page(scenes, record):
    text = ["# Gallery", "",
            f"What Terrarium renders, each with the scene that says so, at most {WIDTH} pixels wide. Beyond size, passes and",
            "what is named nothing was set, and nothing was touched up. Below each picture are the processor time (two cores take half as long) and the relative",
            "error that the render states of itself ([what that is](../GUIDE.md#how-accurate-the-picture-is)); pictures of one pass state none.",
            "`make gallery` renders what has changed and writes this page."]
    for heading, stems in CHAPTERS:
        text += ["", f"## {heading}"]
        for picture in (picture for stem in stems for picture in scenes[stem][0]):
            text += ["", f"![{picture.caption}](../renders/gallery/{picture.name}.png)", "",
                     f"**{picture.caption}**", "", line(picture, record[picture.name])]
    return "\n".join(text) + "\n"


def main():
    draft, again = "--draft" in sys.argv, "--again" in sys.argv
    words = sys.argv[1:]
    most = int(words.pop(words.index("--passes") + 1)) if "--passes" in words else None
    only = [word for word in words if not word.startswith("--")]
    scenes = {stem: read(stem) for _, stems in CHAPTERS for stem in stems}
    out = os.path.join(ROOT, "renders", "draft" if draft else "gallery")
    os.makedirs(out, exist_ok=True)
    book = os.path.join(out, "pictures.json")
    record = {} if draft else load(book)
    begun = time.monotonic()
    for stem, (pictures, size) in scenes.items():
        for picture in pictures:
            if only and not {stem, picture.name} & set(only):
                continue
            options = picture.options + smaller(size, draft) + fewer_passes(picture, draft, most)
            if draft:
                options = without_error(options)
            if picture.layer:
                options += ["--passes", "1"]
            while options.count("--passes") > 1:
                del options[options.index("--passes"):options.index("--passes") + 2]
            file = os.path.join(out, picture.name + ".png")
            asked = options + [picture.layer or ""]
            kept = record.get(picture.name)
            fresh = kept and kept["options"] == asked and os.path.exists(file) and all(
                os.path.exists(os.path.join(ROOT, name)) and sha(name) == value
                for name, value in kept["files"].items())
            if fresh and not again:
                continue
            before = processor_seconds()
            stats, files = render(picture, options, file)
            seconds = processor_seconds() - before
            accuracy = stats["accuracy"]
            made = {
                "options": asked, "processor_seconds": round(seconds, 1), "passes": stats["passes"],
                "error": accuracy and accuracy["error"], "interval": accuracy and accuracy["interval"],
                "files": {name: sha(name) for name in files},
            }
            bytes_ = os.path.getsize(file)
            error = "" if not accuracy else f", error {100 * accuracy['error']:.2g} %"
            print(f"{picture.name}: {told(seconds)}{error}, {bytes_ // 1000} kB", flush=True)
            if bytes_ > LARGEST:
                print(f"  {picture.name}.png is large for a page")
            for warning in stats["warnings"]:
                print(f"  {warning}")
            if not draft:
                record = load(book) | {picture.name: made}
                write(book, json.dumps(record, indent=1, sort_keys=True) + "\n")
    print(f"the gallery took {time.monotonic() - begun:.0f} s")
    # As they are now: another run may have finished meanwhile.
    scenes, record = {stem: read(stem) for stem in scenes}, record if draft else load(book)
    complete = all(picture.name in record for pictures, _ in scenes.values() for picture in pictures)
    if not draft and complete:
        write(os.path.join(ROOT, "docs", "gallery.md"), page(scenes, record))


def write(file, text):
    with open(file + ".tmp-0", "w", encoding="utf-8") as out:
        out.write(text)
    os.replace(file + ".tmp-0", file)


if __name__ == "__main__":
    main()
