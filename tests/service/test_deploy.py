"""The files of deploy/ against the program: what they name is there, and what operations.md says of
backups is true."""

import json
import re
import shutil
import sqlite3
import subprocess

import pytest

from conftest import BIN_DIR, ROOT, Server

DEPLOY = ROOT / "deploy"


@pytest.fixture(scope="module")
def options():
    """Names of all options, as the file of --config has them."""
    printed = subprocess.run([BIN_DIR / "modelsynthd", "--print-config"], check=True,
                             capture_output=True, text=True, timeout=30).stdout
    names = set(re.findall(r"^#? ?([a-z-]+) =", printed, re.MULTILINE))
    assert "listen" in names and "keys" in names
    return names


def configurations():
    """Texts of configuration files, by where they stand."""
    kubernetes = (DEPLOY / "kubernetes/modelsynth.yaml").read_text()
    inner = re.search(r"modelsynthd\.conf: \|\n((?:    .*\n)+)", kubernetes)[1]
    return {"modelsynthd.conf": (DEPLOY / "modelsynthd.conf").read_text(),
            "kubernetes": re.sub(r"^    ", "", inner, flags=re.MULTILINE)}


@pytest.mark.parametrize("name", configurations())
def test_configurations_are_taken(tmp_path, name):
    keys = tmp_path / "keys.json"
    keys.write_text('{"keys": []}')
    text = configurations()[name].replace("/etc/modelsynth/keys/keys.json", str(keys))
    path = tmp_path / "modelsynthd.conf"
    path.write_text(text)
    done = subprocess.run([BIN_DIR / "modelsynthd", "--config", path, "--check-config"],
                          capture_output=True, text=True, timeout=30)
    assert done.returncode == 0, done.stderr


def test_options_that_are_named_exist(options):
    texts = [(DEPLOY / "operations.md").read_text(), (DEPLOY / "systemd/modelsynthd.service").read_text()]
    named = {name for text in texts for name in re.findall(r"(?<![\w-])--([a-z][a-z-]+)", text)}
    assert len(named) > 8
    assert named - options <= {"config", "check-config", "now"}
    container = (DEPLOY / "container/Containerfile").read_text()
    variables = re.findall(r"MODELSYNTH_([A-Z_]+)=", container)
    assert variables
    assert {name.lower().replace("_", "-") for name in variables if name != "TESTS"} <= options


def test_metrics_that_are_named_exist():
    # Of a server that runs only those are told that something has happened to.
    source = (ROOT / "server/ops/metrics.cpp").read_text()
    served = set(re.findall(r'"(modelsynth_\w+)"', source))
    assert "modelsynth_jobs_total" in served
    for path in ("prometheus/alerts.yml", "grafana/modelsynth.json"):
        text = (DEPLOY / path).read_text()
        named = {re.sub(r"_bucket$", "", name)
                 for name in re.findall(r"\b(modelsynth_\w+)\b", text)}
        assert len(named) > 4
        assert named <= served, path


@pytest.mark.skipif(shutil.which("promtool") is None, reason="promtool is not installed")
def test_promtool_finds_nothing_wrong(server):
    server.wait(server.submit()["id"])
    server.get("/nowhere")
    metrics = server.get("/metrics").body
    assert metrics.count(b"\n") > 100
    for arguments, text in ((["metrics"], metrics),
                            (["rules", DEPLOY / "prometheus/alerts.yml"], b""),
                            (["config", "--syntax-only", DEPLOY / "prometheus/scrape.yml"], b"")):
        done = subprocess.run(["promtool", "check", *arguments], input=text, capture_output=True,
                              timeout=60)
        assert (done.returncode, done.stderr) == (0, b""), arguments


def test_the_dashboard_is_one():
    dashboard = json.loads((DEPLOY / "grafana/modelsynth.json").read_text())
    places = [tuple(panel["gridPos"].values()) for panel in dashboard["panels"]]
    assert len(places) == len(set(places)) > 8
    assert len({panel["id"] for panel in dashboard["panels"]}) == len(places)


def test_graces_are_longer_than_the_drain():
    text = (DEPLOY / "modelsynthd.conf").read_text()
    drain = sum(int(re.search(rf"^drain-{name} = (\d+)", text, re.MULTILINE)[1])
                for name in ("delay", "timeout"))
    for path, pattern in (("systemd/modelsynthd.service", r"TimeoutStopSec=(\d+)"),
                          ("container/compose.yaml", r"stop_grace_period: (\d+)s"),
                          ("kubernetes/modelsynth.yaml", r"terminationGracePeriodSeconds: (\d+)")):
        assert int(re.search(pattern, (DEPLOY / path).read_text())[1]) > drain, path


def test_a_backup_of_a_running_server_can_be_restored(tmp_path):
    server = Server(tmp_path / "data").start()
    jobs = [server.submit(seed=seed, size=(10, 6, 10)) for seed in range(3)]
    ended = [server.wait(job["id"]) for job in jobs]
    models = [server.get(job["urls"]["model"]).body for job in ended]
    waiting = server.submit(size=(300, 10, 300), parameters={
        "blocks": {"size": [20, 10, 20], "overlap": 0.75, "passes": 60}})
    backup = tmp_path / "backup"
    backup.mkdir()
    with sqlite3.connect(f"file:{tmp_path}/data/modelsynth.db?mode=ro", uri=True) as database:
        database.execute("VACUUM INTO ?", (str(backup / "modelsynth.db"),))
    database.close()
    shutil.copytree(tmp_path / "data/artifacts", backup / "artifacts")
    server.request("DELETE", ended[0]["urls"]["self"])
    server.kill()

    restored = Server(backup).start()
    try:
        for job, model in zip(ended, models):
            assert restored.get(job["urls"]["self"]).json() == job
            assert restored.get(job["urls"]["model"]).body == model
        # What was running goes on.
        assert restored.get(waiting["urls"]["self"]).json()["state"] in ("queued", "running")
        restored.request("POST", waiting["urls"]["cancel"])
    finally:
        assert restored.stop() == 0
