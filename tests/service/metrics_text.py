"""Prometheus' text format (version 0.0.4), read strictly and judged by the rules of promtool.

promtool itself checks too where it is installed; its package brings a whole monitoring server, so
nothing here depends on it.
"""

import re
import shutil
import subprocess

NAME = r"[a-zA-Z_:][a-zA-Z0-9_:]*"
SAMPLE = re.compile(rf"({NAME})(?:\{{(.*)\}})? (\S+)")
LABEL = re.compile(r'([a-zA-Z_][a-zA-Z0-9_]*)="((?:[^"\\\n]|\\["\\n])*)"(,|$)')
TYPES = {"counter", "gauge", "histogram"}


def _labels(text):
    labels = {}
    while text:
        match = LABEL.match(text)
        assert match, f"not a label: {text}"
        assert match[1] not in labels
        labels[match[1]] = match[2]
        text = text[match.end():]
    return labels


def parse(text):
    """{(name, sorted label pairs): value} of every sample; fails unless the text is well-formed."""
    assert text.endswith("\n") and "\n\n" not in text
    helps, types, samples, family = {}, {}, {}, None
    for line in text[:-1].split("\n"):
        if line.startswith("# HELP "):
            _, _, family, told = line.split(" ", 3)
            assert family not in helps and told
            helps[family] = told
        elif line.startswith("# TYPE "):
            _, _, name, kind = line.split(" ")
            assert name == family and name not in types and kind in TYPES
            types[name] = kind
        else:
            match = SAMPLE.fullmatch(line)
            assert match, line
            name, labels = match[1], _labels(match[2] or "")
            suffixes = ("_bucket", "_sum", "_count") if types[family] == "histogram" else ("",)
            assert name in [family + suffix for suffix in suffixes], f"{line} is not of {family}"
            key = (name, tuple(sorted(labels.items())))
            assert key not in samples, f"{line} stands there twice"
            samples[key] = float(match[3])
    _lint(types, samples)
    return samples


def _lint(types, samples):
    for name, kind in types.items():
        assert re.fullmatch(r"[a-z][a-z0-9_]*", name)
        assert (kind == "counter") == name.endswith("_total"), name
        assert not name.endswith(("_count", "_sum", "_bucket", "_milliseconds", "_info_total"))
        if kind == "histogram":
            _check_histogram(name, samples)


def _check_histogram(name, samples):
    series = {}
    for (sample, labels), value in samples.items():
        if sample == name + "_bucket":
            rest = tuple(label for label in labels if label[0] != "le")
            series.setdefault(rest, []).append((float(dict(labels)["le"]), value))
    for labels, buckets in series.items():
        assert buckets == sorted(buckets) and buckets[-1][0] == float("inf"), name
        counts = [count for _, count in buckets]
        assert counts == sorted(counts) and counts[-1] == samples[(name + "_count", labels)]
        assert (name + "_sum", labels) in samples


def check(text):
    """The samples of a text that promtool, if there is one, has nothing to say about."""
    samples = parse(text)
    if shutil.which("promtool"):
        told = subprocess.run(["promtool", "check", "metrics"], input=text, text=True,
                              capture_output=True, timeout=60)
        assert told.returncode == 0 and not told.stdout + told.stderr, told
    return samples


def value(samples, name, **labels):
    """The sum of the samples of a name that have these labels at least."""
    return sum(number for (sample, own), number in samples.items()
               if sample == name and labels.items() <= dict(own).items())
