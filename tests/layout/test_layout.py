"""The tree is the architecture: which part may include which, and what a part must have."""

import pathlib
import re
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]

# What the files under a folder may include of the project, longest folder first.
ALLOWED = {
    "clients/cli/run_local.cpp": ["clients/", "proto/", "solver/"],
    "clients/": ["clients/", "proto/"],
    "server/store/": ["server/store/", "proto/"],
    "server/log/": ["server/log/"],
    "server/webhooks/": ["server/webhooks/", "server/store/", "server/log/", "proto/"],
    "server/access/": ["server/access/", "server/store/", "proto/"],
    "server/jobs/": ["server/jobs/", "server/store/", "server/log/", "proto/", "solver/"],
    "server/http/": ["server/http/", "server/stream/", "server/access/", "server/jobs/",
                     "server/store/", "server/log/", "proto/", "solver/"],
    "server/": ["server/", "proto/", "solver/"],
    "proto/": ["proto/", "solver/"],
    "solver/core/": ["solver/core/"],
    "solver/mesh/": ["solver/mesh/", "solver/core/"],
    "solver/discrete/": ["solver/discrete/", "solver/mesh/", "solver/core/"],
    "solver/registry/": ["solver/"],
    "solver/examples/": ["solver/"],
    "solver/": ["solver/"],
}

# What a layer must know nothing of.
FORBIDDEN = {
    "solver/": ["boost/", "nlohmann/", "spdlog/", "sqlite3.h", "openssl/", "chrono"],
    "proto/": ["boost/", "spdlog/", "sqlite3.h", "thread", "mutex"],
    "server/store/": ["boost/", "spdlog/", "prometheus/"],
    "server/jobs/": ["boost/", "prometheus/"],
    "server/http/": ["prometheus/"],
}


def sources():
    listed = subprocess.run(["git", "ls-files", "--", "*.h", "*.cpp"], cwd=ROOT, check=True,
                            capture_output=True, text=True).stdout.split()
    return [path for path in listed if not path.startswith("tests/")]


def includes(path):
    return re.findall(r'^#include ["<]([^">]+)[">]', (ROOT / path).read_text(), re.MULTILINE)


def rule(table, path):
    return next((table[folder] for folder in sorted(table, key=len, reverse=True)
                 if path.startswith(folder)), None)


@pytest.mark.parametrize("path", sources())
def test_includes_point_the_right_way(path):
    allowed = rule(ALLOWED, path)
    assert allowed is not None, f"{path} is in no known folder"
    own = [name for name in includes(path)
           if name.startswith(("solver/", "proto/", "server/", "clients/", "tests/"))]
    wrong = [name for name in own if not name.startswith(tuple(allowed))]
    assert not wrong


@pytest.mark.parametrize("path", sources())
def test_layers_know_no_libraries_of_others(path):
    if path == "solver/examples/make_examples.cpp":
        return
    if path == "solver/mesh/glb_scene.cpp":  # glTF is JSON, and tinygltf loses some of it
        assert [name for name in includes(path) if "json" in name] == ["nlohmann/json.hpp"]
        return
    forbidden = rule(FORBIDDEN, path) or []
    wrong = [name for name in includes(path)
             if any(name == word or (word.endswith("/") and name.startswith(word))
                    for word in forbidden)]
    assert not wrong


def test_the_json_library_stays_out_of_public_headers():
    headers = [path for path in sources() if path.endswith(".h")]
    with_json = [path for path in headers if any("nlohmann" in name for name in includes(path))]
    assert with_json == ["proto/json.h"]  # private to proto's sources
    users = [path for path in sources() if '"proto/json.h"' in (ROOT / path).read_text()]
    assert all(path.startswith("proto/") for path in users)


def test_awaiting_expressions_build_no_lambda_or_aggregate():
    """gcc 12 destroys such temporaries twice."""
    for path in sources():
        if not path.startswith("server/"):
            continue
        for statement in re.findall(r"co_await[^;]*;", (ROOT / path).read_text()):
            assert not re.search(r"\[[&=\w, ]*\]\s*(\(|\{)", statement), f"{path}: {statement}"
            assert not re.search(r"[\w>]\{", statement.replace("Exchange{}", "")), \
                f"{path}: {statement}"


@pytest.mark.parametrize("folder", [
    "solver", "solver/core", "solver/core/sat", "solver/discrete", "solver/discrete/analysis",
    "solver/discrete/explanation", "solver/mesh", "solver/examples", "solver/registry", "proto", "server", "server/log", "server/store", "server/jobs",
    "server/http", "server/stream", "server/ops", "server/webhooks", "clients", "clients/cli", "tests", "deploy"])
def test_every_folder_says_what_it_is(folder):
    text = (ROOT / folder / "README.md").read_text()
    assert 0 < len(text.splitlines()) <= 40


def test_the_top_level_is_as_designed():
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True,
                            text=True).stdout.split()
    tops = {path.split("/")[0] for path in listed if not path.startswith(".")}
    assert tops == {"CMakeLists.txt", "README.md", "LICENSE", "CMakePresets.json", "server",
                    "solver", "proto", "clients", "tests", "deploy"}
