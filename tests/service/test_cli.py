"""The client against a real server, and by itself. Seen only from outside: arguments, exit codes,
standard output and error, files."""

import base64
import json
import os
import pathlib
import signal
import struct
import subprocess
import time
import urllib.error
import urllib.request

import pytest
from test_continuous import HUT

ROOT = pathlib.Path(__file__).parents[2]
BIN_DIR = pathlib.Path(os.environ.get("MODELSYNTH_BIN_DIR", ROOT / "build/release/bin"))
BINARY = BIN_DIR / "modelsynth"
NOWHERE = "http://127.0.0.1:1"  # port 1 is not listened on
SMALL = ["--example", "castle", "--size", "20x6x20", "--seed", "7"]
# Half a minute of solving, for tests that end it early.
LONG = ["--example", "castle", "--size", "200x10x200", "--seed", "7"]
LONG += ["--parameters", '{"blocks": {"passes": 100}}']
LINE = {
    "kind": "discrete",
    "name": "line",
    "pieces": [{"name": "empty"}, {"name": "ground"}, {"name": "wall", "weight": 2}],
    "size": [4, 2, 3],
    "cells": [1] * 12 + [0, 2, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0],
    "empty": "empty",
}


def cli(*arguments, server=None, stdin=None, timeout=120):
    environment = {k: v for k, v in os.environ.items() if not k.startswith("MODELSYNTH_")}
    if server is not None:
        environment["MODELSYNTH_SERVER"] = server
    return subprocess.run(
        [BINARY, *map(str, arguments)],
        env=environment,
        input=stdin,
        capture_output=True,
        timeout=timeout,
        check=False,
    )


def succeed(*arguments, **options):
    done = cli(*arguments, **options)
    assert done.returncode == 0, done.stderr.decode()
    return done.stdout.decode()


def fail(code, *arguments, **options):
    """The standard error of a command that must fail, and print nothing else."""
    done = cli(*arguments, **options)
    assert done.returncode == code, (done.returncode, done.stderr.decode())
    assert done.stdout == b""
    return done.stderr.decode()


def get(url):
    with urllib.request.urlopen(url, timeout=60) as answer:
        return answer.read()


def assert_is_glb(data):
    magic, version, length = struct.unpack("<4sII", data[:12])
    assert (magic, version, length) == (b"glTF", 2, len(data))


def submit(server, *arguments):
    job = succeed("submit", *arguments, server=server.url).strip()
    assert job and "\n" not in job
    return job


def wait_for_state(server, job, state):
    for _ in range(600):
        if json.loads(get(f"{server.url}/v1/jobs/{job}"))["state"] == state:
            return
        time.sleep(0.05)
    pytest.fail(f"the job {job} never was {state}")


# --- without a server


def test_local_run_writes_the_same_bytes_every_time(tmp_path):
    for name in ("a.glb", "b.glb"):
        succeed("run", "--local", *SMALL, "-o", tmp_path / name, server=NOWHERE)
    first = (tmp_path / "a.glb").read_bytes()
    assert_is_glb(first)
    assert (tmp_path / "b.glb").read_bytes() == first
    to_stdout = cli("run", "--local", *SMALL, "-o", "-")
    assert to_stdout.stdout == first
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.glb", "b.glb"]


def test_local_run_tells_the_seed_it_drew(tmp_path):
    arguments = ["run", "--local", "--example", "castle", "--size", "20x6x20", "--json"]
    report = json.loads(succeed(*arguments, "-o", tmp_path / "a.glb"))
    assert report["job"] is None
    assert report["file"] == str(tmp_path / "a.glb")
    assert report["bytes"] == (tmp_path / "a.glb").stat().st_size
    again = json.loads(succeed(*arguments, "-o", tmp_path / "b.glb", "--seed", report["seed"]))
    assert again["seed"] == report["seed"]
    assert (tmp_path / "b.glb").read_bytes() == (tmp_path / "a.glb").read_bytes()
    other = json.loads(succeed(*arguments, "-o", tmp_path / "c.glb"))
    assert other["seed"] != report["seed"]


def test_local_run_takes_an_example_file_profiles_and_parameters(tmp_path):
    (tmp_path / "line.json").write_text(json.dumps(LINE))
    (tmp_path / "parameters.json").write_text('{"order": "random"}')
    arguments = ["run", "--local", "--example", tmp_path / "line.json", "--seed", 1]
    sizes = set()
    for profile in ("nodes", "instanced", "merged"):
        out = tmp_path / f"{profile}.glb"
        succeed(
            *arguments, "--size", "8x2x8", "--parameters", tmp_path / "parameters.json",
            "--profile", profile, "-o", out,
        )  # fmt: skip
        assert_is_glb(out.read_bytes())
        sizes.add(out.stat().st_size)
    assert len(sizes) == 3


def test_local_run_takes_a_whole_request_from_standard_input(tmp_path):
    request = {
        "solver": "discrete",
        "example": "castle",
        "seed": 7,
        "parameters": {"size": [20, 6, 20]},
    }
    out = tmp_path / "a.glb"
    succeed("run", "--local", "--request", "-", "-o", out, stdin=json.dumps(request).encode())
    assert cli("run", "--local", *SMALL, "-o", "-").stdout == out.read_bytes()


def test_an_interrupted_local_run_leaves_no_file(tmp_path):
    run = subprocess.Popen(
        [BINARY, "run", "--local", *LONG, "-o", tmp_path / "a.glb"], stderr=subprocess.PIPE
    )
    assert b"started" in run.stderr.readline()
    run.send_signal(signal.SIGINT)
    _, errors = run.communicate(timeout=20)
    assert run.returncode == 130
    assert b"interrupted" in errors
    assert list(tmp_path.iterdir()) == []


def test_a_local_run_past_its_deadline_fails(tmp_path):
    errors = fail(
        1, "run", "--local", *LONG, "--deadline", 0.05, "--json", "-o", tmp_path / "a.glb"
    )
    assert json.loads(errors)["type"] == "/problems/deadline-exceeded"
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_fails_and_leaves_no_file():
    for arguments in (["-o", "-"], ["-o", "/dev/full"], ["-o", "/dev/null", "--json"]):
        with open("/dev/full", "wb") as full:
            done = subprocess.run(
                [BINARY, "run", "--local", *SMALL, *arguments],
                stdout=full,
                stderr=subprocess.PIPE,
                check=False,
            )
        assert done.returncode == 1 and b"cannot write" in done.stderr


def test_a_request_that_cannot_be_done_tells_every_fault(tmp_path):
    arguments = [
        "run", "--local", "--example", "nonesuch", "--size", "0x10x40", "-o", tmp_path / "a.glb",
    ]  # fmt: skip
    lines = fail(1, *arguments).splitlines()
    assert lines[0].startswith("modelsynth: ")
    assert any(line.startswith("  /example: ") for line in lines[1:])
    assert any(line.startswith("  /parameters/size/0: ") for line in lines[1:])
    problem = json.loads(fail(1, *arguments, "--json"))
    assert problem["type"] == "/problems/invalid-request"
    assert {"/example", "/parameters/size/0"} <= {e["pointer"] for e in problem["errors"]}
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["nonesuch"],
        ["list", "--nonesuch"],
        ["list", "--state", "nonesuch"],
        ["list", "--limit", "0"],
        ["list", "--server", "ftp://example.org"],
        ["list", "--server", "127.0.0.1:8080"],
        ["list", "--key", "a\r\nX: y"],
        ["submit"],
        ["submit", "--example", "castle", "--request", "a.json"],
        ["submit", "--from", "1", "--request", "a.json"],
        ["submit", "--from", ""],
        ["submit", "--from", "1", "--box", "0,0,0"],
        ["submit", "--from", "1", "--at", "1x2x3"],
        ["submit", "--example", "castle", "--box", "0,0,0:1,1,1"],
        ["submit", "--example", "castle", "--at", "1,2,3"],
        ["run", "--local", "--from", "1", "-o", "a.glb"],
        ["submit", "--example", "castle", "--size", "40x10"],
        ["submit", "--example", "castle", "--size", "40x10x40x1"],
        ["submit", "--example", "castle", "--seed", "-1"],
        ["submit", "--example", "castle", "--seed", "x"],
        ["follow", "1", "--after", "-1"],
        ["submit", "--example", "castle", "--parameters", "{"],
        ["submit", "--example", "castle", "--tag", "level"],
        ["submit", "--example", "./nonesuch.json"],
        ["submit", "--request", "nonesuch.json"],
        ["run", "--local", "--example", "castle"],
        ["run", "--local", "--example", "castle", "-o", "/nonesuch/a.glb"],
        ["run", "--local", "--example", "castle", "-o", "/"],
        ["run", "--local", "--example", "castle", "-o", "a.glb", "--profile", "nonesuch"],
        ["fetch", "1"],
        ["fetch", "", "-o", "a.glb"],
        ["fetch", "1", "-o", "a.glb", "--labels", "--preview"],
        ["follow"],
        ["cancel", ""],
        ["delete"],
        ["upload", "nonesuch.json"],
    ],
)
def test_wrong_usage_exits_with_2_and_one_line(arguments):
    errors = fail(2, *arguments, server=NOWHERE)
    assert errors.startswith("modelsynth: ") and errors.count("\n") == 1
    if arguments:
        assert "detail" in json.loads(fail(2, *arguments, "--json", server=NOWHERE))


def test_json_and_a_model_do_not_share_standard_output():
    fail(2, "run", "--local", *SMALL, "-o", "-", "--json")
    fail(2, "fetch", "1", "-o", "-", "--json", server=NOWHERE)


def test_an_option_wins_over_the_environment():
    other = "http://127.0.0.1:2"
    assert f"{other}:" in fail(3, "list", "--server", other, server=NOWHERE)


@pytest.mark.parametrize(
    "command",
    ["submit", "follow", "fetch", "list", "cancel", "delete", "upload", "examples", "run"],
)
def test_help_tells_the_exit_codes(command):
    text = succeed(command, "--help")
    assert "--json" in text and "--server" in text and "$MODELSYNTH_SERVER" in text
    assert "130  interrupted" in text
    for option in ("--from JOB", "--box X,Y,Z:X,Y,Z", "--at X,Y,Z"):
        assert (option in text) == (command in ("submit", "run"))


@pytest.mark.parametrize(
    "arguments",
    [
        ["list"],
        ["examples"],
        ["cancel", "1"],
        ["delete", "1"],
        ["fetch", "1", "-o", "nonesuch.glb"],
        ["submit", "--example", "castle"],
        ["run", "--example", "castle", "-o", "nonesuch.glb"],
    ],
)
def test_an_unreachable_server_exits_with_3(arguments):
    assert "cannot reach http://127.0.0.1:1" in fail(3, *arguments, server=NOWHERE)
    assert "detail" in json.loads(fail(3, *arguments, "--json", "--server", NOWHERE))
    assert not pathlib.Path("nonesuch.glb").exists()


# --- with a server


@pytest.mark.parametrize("compression", ["none", "meshopt"])
@pytest.mark.parametrize("profile", ["nodes", "instanced", "merged"])
def test_local_run_equals_the_server_in_every_form(server, tmp_path, profile, compression):
    form = ["--profile", profile, "--compression", compression]
    local, remote = tmp_path / "local.glb", tmp_path / "remote.glb"
    succeed("run", "--local", *SMALL, *form, "-o", local)
    succeed("run", *SMALL, *form, "-o", remote, server=server.url)
    assert local.read_bytes() == remote.read_bytes()
    assert (b"EXT_meshopt_compression" in local.read_bytes()) == (compression == "meshopt")


def test_the_solver_is_that_of_the_example(server, tmp_path):
    (tmp_path / "own.json").write_text(json.dumps(HUT))
    for example in ("domes", tmp_path / "own.json"):
        for where, place in (("here.glb", {}), ("there.glb", {"server": server.url})):
            local = [] if place else ["--local"]
            succeed("run", *local, "--example", example, "--seed", 4, "-o", tmp_path / where,
                    **place)
        assert (tmp_path / "here.glb").read_bytes() == (tmp_path / "there.glb").read_bytes()


def test_local_run_of_an_example_file_equals_the_server(server, tmp_path):
    (tmp_path / "line.json").write_text(json.dumps(LINE))
    arguments = ["run", "--example", tmp_path / "line.json", "--size", "9x2x7", "--seed", 3]
    succeed(*arguments, "--local", "-o", tmp_path / "local.glb")
    succeed(*arguments, "-o", tmp_path / "remote.glb", server=server.url)
    assert (tmp_path / "local.glb").read_bytes() == (tmp_path / "remote.glb").read_bytes()


def test_run_reports_as_json(server, tmp_path):
    out = tmp_path / "a.glb"
    report = json.loads(succeed("run", *SMALL, "-o", out, "--json", server=server.url))
    job = json.loads(get(f"{server.url}/v1/jobs/{report['job']}"))
    assert job["state"] == "succeeded"
    assert report["seed"] == job["seed"] == 7
    assert report["bytes"] == job["result"]["bytes"] == out.stat().st_size
    assert report["blocks_accepted"] == job["result"]["stats"]["blocks_accepted"] > 0


def test_submit_follow_and_fetch(server, tmp_path):
    job = submit(server, *SMALL, "--tag", "level=3", "--priority", -2, "--deadline", 60)
    request = json.loads(get(f"{server.url}/v1/jobs/{job}"))["request"]
    assert request["tags"] == {"level": "3"}
    assert (request["priority"], request["deadline"]) == (-2, 60)

    followed = cli("follow", job, server=server.url)
    assert followed.returncode == 0 and followed.stdout == b""
    assert b"succeeded" in followed.stderr

    out = tmp_path / "a.glb"
    succeed("fetch", job, "-o", out, server=server.url)
    assert out.read_bytes() == get(f"{server.url}/v1/jobs/{job}/model.glb")
    assert cli("fetch", job, "-o", "-", server=server.url).stdout == out.read_bytes()

    labels = tmp_path / "labels.json"
    report = json.loads(
        succeed("fetch", job, "--labels", "-o", labels, "--json", server=server.url)
    )
    assert report["bytes"] == labels.stat().st_size
    assert json.loads(labels.read_text())["size"] == [20, 6, 20]

    instanced = tmp_path / "instanced.glb"
    succeed("fetch", job, "--profile", "instanced", "-o", instanced, server=server.url)
    assert_is_glb(instanced.read_bytes())
    assert instanced.read_bytes() != out.read_bytes()
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["a.glb", "instanced.glb", "labels.json"]


def test_follow_gives_every_event_once_as_json(server):
    job = submit(server, *SMALL)
    lines = succeed("follow", job, "--json", server=server.url).splitlines()
    events = [json.loads(line) for line in lines]
    assert [event["seq"] for event in events] == list(range(1, len(events) + 1))
    assert events[0]["type"] == "queued" and events[-1]["type"] == "succeeded"
    rest = succeed("follow", job, "--json", "--after", 3, server=server.url).splitlines()
    assert [json.loads(line) for line in rest] == events[3:]


def test_follow_after_the_last_event_tells_the_outcome(server):
    job = submit(server, *SMALL)
    last = json.loads(succeed("follow", job, "--json", server=server.url).splitlines()[-1])["seq"]
    assert succeed("follow", job, "--json", "--after", last, server=server.url) == ""
    fail(1, "follow", job, "--after", last + 1, server=server.url)


def test_submit_with_an_output_follows_and_fetches(server, tmp_path):
    out = tmp_path / "a.glb"
    done = cli("submit", *SMALL, "-o", out, server=server.url)
    assert done.returncode == 0
    job = done.stdout.decode().strip()
    assert out.read_bytes() == get(f"{server.url}/v1/jobs/{job}/model.glb")
    assert f"{out}: {out.stat().st_size} bytes" in done.stderr.decode()

    lines = succeed("submit", *SMALL, "--follow", "--json", server=server.url).splitlines()
    documents = [json.loads(line) for line in lines]
    assert documents[0]["state"] in ("queued", "running")
    assert documents[-1]["type"] == "succeeded"


def test_a_whole_request_and_an_idempotency_key(server, tmp_path):
    request = tmp_path / "request.json"
    request.write_text(
        json.dumps({"solver": "discrete", "example": "castle", "parameters": {"size": [8, 6, 8]}})
    )
    arguments = ["submit", "--request", request, "--idempotency-key", f"key-{os.getpid()}"]
    first = succeed(*arguments, server=server.url)
    assert succeed(*arguments, server=server.url) == first
    request.write_text(request.read_text().replace("castle", "city"))
    errors = fail(1, *arguments, "--json", server=server.url)
    assert json.loads(errors)["type"] == "/problems/idempotency-conflict"


def test_a_refused_request_shows_the_problem(server, tmp_path):
    errors = fail(1, "submit", "--example", "castle", "--size", "0x10x40", server=server.url)
    assert "  /parameters/size/0: " in errors
    broken = tmp_path / "broken.json"
    broken.write_text("{")
    errors = fail(1, "submit", "--request", broken, "--json", server=server.url)
    assert json.loads(errors)["status"] == 400


def test_a_job_is_submitted_from_a_finished_one(server, tmp_path):
    first = submit(server, *SMALL)
    succeed("follow", first, server=server.url)
    box = ["--box", "2,0,3:12,6,13"]
    job = submit(server, "--from", first, *box, "--seed", 8)
    succeed("follow", job, server=server.url)
    request = json.loads(get(f"{server.url}/v1/jobs/{job}"))["request"]
    assert request["from"] == {
        "job": first, "size": [20, 6, 20], "at": [0, 0, 0],
        "box": {"min": [2, 0, 3], "max": [12, 6, 13]},
    }  # fmt: skip
    assert (request["example"], request["seed"]) == ("castle", 8)
    out = tmp_path / "grown.glb"
    report = json.loads(succeed(
        "run", "--from", first, "--at", "3,0,4", "--size", "24x6x25", "--example", "castle",
        "-o", out, "--json", server=server.url,
    ))  # fmt: skip
    grown = json.loads(get(f"{server.url}/v1/jobs/{report['job']}"))["request"]
    assert grown["from"]["at"] == [3, 0, 4] and grown["parameters"]["size"] == [24, 6, 25]
    assert_is_glb(out.read_bytes())
    errors = fail(1, "submit", "--from", "nonesuch", server=server.url)
    assert "/from/job" in errors


def series_files(directory):
    return {path.name: path.read_bytes() for path in directory.iterdir()}


def test_several_models_come_as_numbered_files_from_the_server_and_without(server, tmp_path):
    made = {}
    for where, options in (("server", {"server": server.url}), ("local", {})):
        (tmp_path / where).mkdir()
        report = json.loads(succeed(
            "run", *SMALL, "--alternatives", 3, "-o", tmp_path / where / "castle.glb", "--json",
            *([] if options else ["--local"]), **options,
        ))  # fmt: skip
        names = [f"{tmp_path}/{where}/castle{end}.glb" for end in ("", "-1", "-2")]
        assert [entry["file"] for entry in report["alternatives"]] == names
        assert report["file"] == names[0]
        made[where] = series_files(tmp_path / where)
        assert [entry["bytes"] for entry in report["alternatives"]] == \
               [len(made[where][os.path.basename(name)]) for name in names]
    assert made["server"] == made["local"]
    assert len(set(made["server"].values())) == 3
    # The same ones by themselves.
    job = json.loads(get(f"{server.url}/v1/jobs?limit=1"))["items"][0]["id"]
    for number, name in enumerate(("castle.glb", "castle-1.glb", "castle-2.glb")):
        out = tmp_path / "one.glb"
        succeed("fetch", job, "--alternative", number, "-o", out, server=server.url)
        assert out.read_bytes() == made["server"][name]
        succeed("fetch", job, "--alternative", number, "--labels", "-o", out, server=server.url)
        assert json.loads(out.read_text())["size"] == [20, 6, 20]
    fail(1, "fetch", job, "--alternative", 3, "-o", out, server=server.url)
    fail(2, "fetch", job, "--alternative", 0, "--preview", "-o", out, server=server.url)


def test_several_models_without_a_server_keep_their_names_in_every_profile(tmp_path):
    out = tmp_path / "castle.glb"
    succeed("run", "--local", *SMALL, "--alternatives", 2, "--profile", "merged", "-o", out)
    files = series_files(tmp_path)
    assert set(files) == {"castle.glb", "castle-1.glb"}
    assert len(set(files.values())) == 2
    assert "standard output" in fail(
        2, "run", "--local", *SMALL, "--alternatives", 2, "-o", "-")


def test_list_shows_jobs_newest_first(server):
    jobs = [submit(server, *SMALL) for _ in range(3)]
    succeed("follow", jobs[-1], server=server.url)
    page = json.loads(succeed("list", "--limit", 2, "--json", server=server.url))
    assert [item["id"] for item in page["items"]] == [jobs[2], jobs[1]]
    table = succeed("list", "--limit", 200, server=server.url).splitlines()
    assert table[0].split()[:2] == ["ID", "STATE"]
    ids = [line.split()[0] for line in table[1:]]
    assert [job for job in ids if job in jobs] == jobs[::-1]
    succeeded = succeed("list", "--state", "succeeded", server=server.url).splitlines()[1:]
    assert all(line.split()[1] == "succeeded" for line in succeeded)
    assert any(line.split()[0] == jobs[-1] for line in succeeded)


def test_cancel_stops_a_job_and_follow_tells(server, tmp_path):
    job = submit(server, *LONG)
    wait_for_state(server, job, "running")
    fetch = fail(1, "fetch", job, "-o", tmp_path / "a.glb", "--json", server=server.url)
    assert json.loads(fetch)["type"] == "/problems/not-finished"
    assert succeed("cancel", job, server=server.url).startswith(job)
    assert f"the job {job} was cancelled" in cli("follow", job, server=server.url).stderr.decode()
    assert cli("follow", job, "--json", server=server.url).returncode == 1
    assert json.loads(succeed("cancel", job, "--json", server=server.url))["state"] == "cancelled"
    assert list(tmp_path.iterdir()) == []


def test_a_failed_job_exits_with_1_and_its_problem(server, tmp_path):
    arguments = ["run", *LONG, "--deadline", 0.05, "-o", tmp_path / "a.glb"]
    problem = json.loads(fail(1, *arguments, "--json", server=server.url))
    assert problem["type"] == "/problems/deadline-exceeded"
    assert list(tmp_path.iterdir()) == []


def test_an_interrupted_follow_leaves_the_job_running(server):
    job = submit(server, *LONG)
    wait_for_state(server, job, "running")
    follow = subprocess.Popen(
        [BINARY, "follow", job, "--server", server.url], stderr=subprocess.PIPE
    )
    follow.stderr.readline()
    follow.send_signal(signal.SIGINT)
    _, errors = follow.communicate(timeout=20)
    assert follow.returncode == 130 and b"goes on" in errors
    assert json.loads(get(f"{server.url}/v1/jobs/{job}"))["state"] == "running"
    succeed("cancel", job, server=server.url)


def test_delete_forgets_a_job(server):
    job = submit(server, *SMALL)
    succeed("follow", job, server=server.url)
    assert json.loads(succeed("delete", job, "--json", server=server.url))["deleted"] is True
    with pytest.raises(urllib.error.HTTPError) as gone:
        get(f"{server.url}/v1/jobs/{job}")
    assert gone.value.code == 404
    for command in (["follow", job], ["cancel", job], ["delete", job]):
        problem = json.loads(fail(1, *command, "--json", server=server.url))
        assert problem["status"] == 404


def test_upload_gives_an_id_to_synthesise_from(server, tmp_path):
    example = tmp_path / "line.json"
    example.write_text(json.dumps(LINE))
    first = succeed("upload", example, server=server.url).strip()
    assert succeed("upload", example, server=server.url).strip() == first
    assert json.loads(succeed("upload", example, "--json", server=server.url))["id"] == first
    ids = [line.split()[0] for line in succeed("examples", server=server.url).splitlines()[1:]]
    assert first in ids and "castle" in ids
    listed = json.loads(succeed("examples", "--json", server=server.url))["items"]
    assert first in [item["id"] for item in listed]
    arguments = ["--size", "9x2x7", "--seed", 3, "-o"]
    succeed("run", "--example", first, *arguments, tmp_path / "a.glb", server=server.url)
    succeed("run", "--local", "--example", example, *arguments, tmp_path / "b.glb")
    assert (tmp_path / "a.glb").read_bytes() == (tmp_path / "b.glb").read_bytes()


def test_upload_sends_the_mesh_file_beside_the_example(server, tmp_path):
    wall = get(f"{server.url}/v1/examples/castle/pieces.glb")
    length = struct.unpack("<I", wall[12:16])[0]
    node = next(n["name"] for n in json.loads(wall[20 : 20 + length])["nodes"] if "mesh" in n)
    (tmp_path / "kit.glb").write_bytes(wall)
    pieces = [LINE["pieces"][0], LINE["pieces"][1], {"name": "wall", "mesh": node}]
    example = tmp_path / "meshed.json"
    example.write_text(json.dumps({**LINE, "pieces": pieces, "meshes": "kit.glb"}))
    first = succeed("upload", example, server=server.url).strip()
    inlined = tmp_path / "inlined.json"
    uri = "data:model/gltf-binary;base64," + base64.b64encode(wall).decode()
    inlined.write_text(json.dumps({**LINE, "pieces": pieces, "meshes": uri}))
    assert succeed("upload", inlined, server=server.url).strip() == first
    for meshes in ("nonesuch.glb", "../kit.glb", "kit.obj"):
        example.write_text(json.dumps({**LINE, "meshes": meshes}))
        fail(2, "upload", example, server=server.url)


def test_an_upload_that_is_no_example_is_refused(server, tmp_path):
    example = tmp_path / "bad.json"
    example.write_text(json.dumps({**LINE, "cells": [1]}))
    assert "  /cells: " in fail(1, "upload", example, server=server.url)
    example.write_text("{")
    fail(2, "upload", example, server=server.url)
