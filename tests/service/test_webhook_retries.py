"""Webhooks that do not arrive: when they are tried again, how many may wait, and what is counted."""

import email.utils
import hashlib
import json
import re
import threading
import time

import pytest

import metrics_text
from api_document import ApiDocument
from checks import assert_problem, job_request, make_job, wait_until
from webhook_receiver import Receiver, reply


def hook(receiver):
    return {"webhook": {"url": receiver.url()}}


def pauses(server):
    """Milliseconds, by job and number of the try before them."""
    found = re.findall(r"webhook failed job=(\S+) try=(\d+) .*pause_ms=(\d+)", server.log_text())
    return {(job, int(number)): int(pause) for job, number, pause in found}


def samples_of(server):
    return metrics_text.check(server.get("/metrics").body.decode())


# --- when they are tried again

def test_pauses_grow_and_differ(hook_server):
    server = hook_server()
    with Receiver(lambda _, handler: reply(handler, 500)) as receiver:
        jobs = [make_job(server, **hook(receiver))["id"] for _ in range(3)]
        wait_until(lambda: server.log_text().count("webhook given up") == 3)
    seen = pauses(server)
    assert set(seen) == {(job, number) for job in jobs for number in range(1, 6)}
    for (_, number), pause in seen.items():
        nominal = 6 ** (number - 1)
        assert round(0.8 * nominal) <= pause <= round(1.2 * nominal)
    # Three of the last alike happen once in 270000 runs.
    assert len({seen[job, 5] for job in jobs}) > 1


def in_three_seconds():
    return email.utils.formatdate(time.time() + 3, usegmt=True)


@pytest.mark.parametrize("status, retry_after, least, most", [
    (503, lambda: "1", 1000, 1200),
    (429, lambda: "1", 1000, 1200),
    (503, in_three_seconds, 200, 3600),
    (429, lambda: "86400", 12960, 12960),  # no longer than the longest pause
    # What is no request to wait leaves the pause as it is.
    (500, lambda: "1", 8, 12),
    (503, lambda: "0", 8, 12),
    (503, lambda: "in a minute", 8, 12),
    (503, lambda: "Sun, 06 Nov 1994 08:49:37 GMT", 8, 12),
])
def test_receivers_say_when_to_come_back(hook_server, status, retry_after, least, most):
    server = hook_server("--webhook-first-delay", "0.01")
    with Receiver(lambda number, handler: reply(
            handler, status if number == 1 else 200,
            [("Retry-After", retry_after())])) as receiver:
        job = make_job(server, **hook(receiver))["id"]
        wait_until(lambda: (job, 1) in pauses(server))
        assert least <= pauses(server)[job, 1] <= most


def test_nobody_comes_back_before(hook_server):
    server = hook_server("--webhook-first-delay", "0.01")
    times = []

    def answer(number, handler):
        times.append(time.monotonic())
        reply(handler, 503 if number == 1 else 200, [("Retry-After", "1")])

    with Receiver(answer) as receiver:
        make_job(server, **hook(receiver))
        receiver.wait(2)
        wait_until(lambda: "webhook delivered" in server.log_text())
    assert times[1] - times[0] > 0.99  # two clocks, one of which may be set


# --- how many may wait

def test_with_as_many_as_may_wait_no_job_has_another(hook_server):
    server = hook_server("--webhooks-waiting-max", 2, "--webhook-first-delay", "0.2")
    limits = server.get("/v1/limits").json()["limits"]
    assert limits["webhooks_waiting_max"]["value"] == 2
    is_open = threading.Event()
    with Receiver(lambda _, handler: reply(handler, 200 if is_open.is_set() else 503)) as receiver:
        kept = {"Idempotency-Key": "first", "Prefer": "wait=60"}
        body = job_request(**hook(receiver))
        first = server.request("POST", "/v1/jobs", body, headers=kept)
        assert first.status == 200
        make_job(server, **hook(receiver))
        refused = server.request("POST", "/v1/jobs", job_request(**hook(receiver)))
        problem = assert_problem(refused, 429, "too-many-webhooks")
        assert problem["detail"].startswith("2 webhooks")
        assert int(refused.headers["retry-after"]) >= 1
        ApiDocument(server.get("/openapi.json").json()).check_answer("POST", "/v1/jobs", refused)
        assert server.get("/problems/too-many-webhooks").status == 200
        # Nothing else is turned away.
        again = server.request("POST", "/v1/jobs", body, headers=kept)
        assert again.json()["id"] == first.json()["id"]
        make_job(server)
        assert metrics_text.value(samples_of(server), "modelsynth_rejected_total",
                                  reason="too-many-webhooks") == 1
        is_open.set()
        wait_until(lambda: server.request(
            "POST", "/v1/jobs", job_request(**hook(receiver))).status == 202)


def test_owners_wait_for_their_own_alone_also_after_a_crash(hook_server, tmp_path):
    keys = tmp_path / "keys.json"
    keys.write_text(json.dumps({"keys": [
        {"name": name, "scopes": ["read", "submit"],
         "sha256": hashlib.sha256(name.encode()).hexdigest()} for name in ("ann", "bob")]}))
    server = hook_server("--webhooks-waiting-max", 1, "--webhook-first-delay", "3600",
                         "--keys", keys)

    def submit(name, **more):
        return server.request("POST", "/v1/jobs", job_request(**more), headers={
            "Authorization": f"Bearer {name}", "Prefer": "wait=60"})

    with Receiver(lambda _, handler: reply(handler, 500)) as receiver:
        job = submit("ann", **hook(receiver))
        assert job.json()["state"] == "succeeded"
        assert_problem(submit("ann", **hook(receiver)), 429, "too-many-webhooks")
        assert submit("bob", **hook(receiver)).json()["state"] == "succeeded"
        server.kill()
        server.start()
        for name in ("ann", "bob"):
            assert_problem(submit(name, **hook(receiver)), 429, "too-many-webhooks")
        deleted = server.request("DELETE", f"/v1/jobs/{job.json()['id']}",
                                 headers={"Authorization": "Bearer ann"})
        assert deleted.status == 204
        assert submit("ann", **hook(receiver)).json()["state"] == "succeeded"
        assert_problem(submit("bob", **hook(receiver)), 429, "too-many-webhooks")


# --- what is counted

def test_tries_are_counted_by_what_became_of_them(hook_server):
    server = hook_server("--webhook-seconds", "60")

    def value(name, **labels):
        return metrics_text.value(samples_of(server), "modelsynth_webhook" + name, **labels)

    told = server.get("/metrics").body.decode()
    for outcome in ("delivered", "retried", "given-up"):
        assert f'modelsynth_webhook_tries_total{{outcome="{outcome}"}} 0\n' in told
    release = threading.Event()
    with Receiver(lambda number, handler: reply(handler, 503 if number < 3 else 204)) as busy, \
            Receiver(lambda _, handler: reply(handler, 410)) as gone, \
            Receiver(lambda _, handler: release.wait(60) and reply(handler, 200)) as hanging:
        make_job(server, **hook(busy))
        make_job(server, **hook(gone))
        wait_until(lambda: value("_try_seconds_count") == 4)
        assert value("_tries_total", outcome="delivered") == 1
        assert value("_tries_total", outcome="retried") == 2
        assert value("_tries_total", outcome="given-up") == 1
        assert value("s_waiting") == 0
        make_job(server, **hook(hanging))
        hanging.wait(1)
        assert value("s_waiting") == 1
        begun = time.monotonic()
        while time.monotonic() - begun < 0.3:  # the receiver takes at least so long
            time.sleep(0.01)
        before = value("_try_seconds_sum")
        release.set()
        wait_until(lambda: value("_tries_total", outcome="delivered") == 2)
    assert value("_try_seconds_sum") - before >= 0.29
    assert value("_try_seconds_count") == 5 and value("s_waiting") == 0
