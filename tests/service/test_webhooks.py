"""Webhooks: what is sent when jobs end, to whom, how often, and whom it must not hold up."""

import datetime
import signal
import socket
import subprocess
import threading
import time

import pytest

from certificate import Certificate
from checks import assert_faults, assert_problem, endless_job, job_request, make_job
from conftest import BIN_DIR, Server
from webhook_receiver import OTHER_SECRET, SECRET, Receiver, reply


@pytest.fixture(scope="module")
def strict(tmp_path_factory):
    folder = tmp_path_factory.mktemp("strict")
    (folder / "secret").write_text(SECRET)
    server = Server(folder / "data", "--webhook-secret-file", folder / "secret",
                    "--webhook-allow-http").start()
    yield server
    server.kill()


def until(condition, seconds=20):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return
        time.sleep(0.01)
    raise AssertionError("it did not come about")


def hook(url):
    return {"webhook": {"url": url}}


# --- what is sent

def test_each_end_is_told_of_and_signed(hook_server):
    server = hook_server(workers=1)
    with Receiver() as receiver:
        good = make_job(server, **hook(receiver.url("/a?b=c")))
        with endless_job(server) as running:  # keeps the worker
            waiting = server.request("POST", "/v1/jobs",
                                     job_request(**hook(receiver.url("/cancelled")))).json()
            server.request("POST", f"/v1/jobs/{waiting['id']}/cancel")
        assert running
        bad = server.request("POST", "/v1/jobs", {
            "solver": "discrete", "example": "castle", "parameters": {"size": [200, 10, 200]},
            "deadline": 0.001, **hook(receiver.url("/failed"))}).json()
        server.wait(bad["id"])
        messages = {message.id: message for message in receiver.wait(3)}
    for job, end, path in ((good, "succeeded", "/a?b=c"), (waiting, "cancelled", "/cancelled"),
                           (bad, "failed", "/failed")):
        message = messages["msg_" + job["id"]]
        assert message.path == path
        assert message.is_signed_with(SECRET) and not message.is_signed_with(OTHER_SECRET)
        assert message.document == {"type": f"job.{end}",
                                    "job": server.get(f"/v1/jobs/{job['id']}").json()}
        assert message.document["job"]["state"] == end
        assert message.document["job"]["request"]["webhook"] == {
            "url": f"http://127.0.0.1:{receiver.port}{path}"}
        assert message.headers["Content-Type"] == "application/json"
        sent = int(message.headers["webhook-timestamp"])
        assert abs(datetime.datetime.now().timestamp() - sent) < 60
    assert len(receiver.messages) == 3
    assert SECRET[8:] not in server.log_text()
    assert receiver.url() not in server.log_text()


def test_a_job_without_one_tells_nobody_and_an_echo_tells_again(hook_server):
    server = hook_server()
    with Receiver() as receiver:
        make_job(server)
        job = make_job(server, **hook(receiver.url()))
        again = server.request("POST", "/v1/jobs", job["request"], headers={"Prefer": "wait=60"})
        assert again.status == 200
        messages = receiver.wait(2)
        assert {message.id for message in messages} == {f"msg_{job['id']}",
                                                        f"msg_{again.json()['id']}"}


def test_a_message_that_fails_is_sent_again_the_same(hook_server):
    server = hook_server()
    answers = [503, 404, 301, 200]
    with Receiver(lambda number, handler: reply(
            handler, answers[number - 1], [("Location", "/elsewhere")])) as receiver:
        job = make_job(server, **hook(receiver.url()))
        messages = receiver.wait(4)
        until(lambda: "webhook delivered" in server.log_text())
    assert len(messages) == 4  # no redirect was followed
    assert {message.id for message in messages} == {f"msg_{job['id']}"}
    assert len({message.body for message in messages}) == 1
    assert all(message.is_signed_with(SECRET) for message in messages)
    assert f"webhook delivered job={job['id']} try=4" in server.log_text()


@pytest.mark.parametrize("status, tries", [(500, 6), (410, 1)])
def test_a_message_is_given_up(hook_server, status, tries):
    server = hook_server()
    with Receiver(lambda _, handler: reply(handler, status)) as receiver:
        job = make_job(server, **hook(receiver.url()))
        until(lambda: f"webhook given up job={job['id']} try={tries}" in server.log_text())
        assert len(receiver.messages) == tries
        server.kill()
        server.start()
        make_job(server, **hook(receiver.url()))
        assert receiver.wait(tries + 1)[-1].id != f"msg_{job['id']}"


def test_an_answer_without_end_is_cut_off(hook_server):
    server = hook_server()

    def pour(_, handler):
        handler.send_response(200)
        handler.end_headers()
        try:
            while True:
                handler.wfile.write(b"x" * 65536)
        except OSError:
            cut.set()

    cut = threading.Event()
    with Receiver(pour) as receiver:
        make_job(server, **hook(receiver.url()))
        assert cut.wait(20)
        until(lambda: "webhook delivered" in server.log_text())
        assert len(receiver.messages) == 1


# --- whom it must not hold up

def test_a_receiver_that_hangs_delays_nobody_else(hook_server):
    server = hook_server()
    release = threading.Event()
    with Receiver(lambda _, handler: release.wait(30)) as hanging, Receiver() as good:
        for _ in range(6):
            make_job(server, **hook(hanging.url()))
        hanging.wait(2)
        begun = time.monotonic()
        make_job(server, **hook(good.url()))
        good.wait(1)
        assert time.monotonic() - begun < 1.5  # less than the time for one answer
        assert len(hanging.messages) <= 4
        # Nor does it hold up the end of the server.
        begun = time.monotonic()
        assert server.stop() == 0
        assert time.monotonic() - begun < 10
        release.set()


def test_what_was_not_delivered_survives_a_crash(hook_server):
    with socket.socket() as closed:
        closed.bind(("127.0.0.1", 0))
        port = closed.getsockname()[1]
    server = hook_server("--webhook-first-delay", "0.5")
    jobs = [make_job(server, **hook(f"http://127.0.0.1:{port}/hook")) for _ in range(2)]
    until(lambda: server.log_text().count("webhook failed") >= 2)
    server.kill()
    with Receiver(port=port) as receiver:
        server.start()
        messages = receiver.wait(2)
        assert {message.id for message in messages} == {f"msg_{job['id']}" for job in jobs}
        assert messages[0].document["job"]["state"] == "succeeded"
        until(lambda: server.log_text().count("webhook delivered") == 2)


def test_a_receiver_that_takes_it_and_says_nothing_gets_it_again_after_a_crash(hook_server):
    server = hook_server("--webhook-seconds", "60")
    held = threading.Event()
    with Receiver(lambda number, handler: held.wait(30) if number == 1 else reply(handler, 204)
                  ) as receiver:
        job = make_job(server, **hook(receiver.url()))
        receiver.wait(1)
        server.kill()
        server.start()
        assert [message.id for message in receiver.wait(2)] == [f"msg_{job['id']}"] * 2
        held.set()


def test_a_deleted_job_tells_nobody(hook_server):
    server = hook_server("--webhook-first-delay", "0.3")
    with Receiver(lambda _, handler: reply(handler, 500)) as receiver:
        gone = make_job(server, **hook(receiver.url("/gone")))
        until(lambda: "webhook failed" in server.log_text())
        assert server.request("DELETE", f"/v1/jobs/{gone['id']}").status == 204
        kept = make_job(server, **hook(receiver.url("/kept")))
        until(lambda: [message.id for message in receiver.messages].count(
            f"msg_{kept['id']}") == 2)
        assert [message.path for message in receiver.messages].count("/gone") == 1


# --- where it may go

def test_names_that_lead_to_private_addresses_are_refused_when_connected(hook_server):
    server = hook_server(private=False)
    with Receiver() as receiver:
        job = make_job(server, **hook(f"http://localhost:{receiver.port}/hook"))
        until(lambda: f"webhook given up job={job['id']}" in server.log_text())
        assert receiver.messages == []
    assert "address is not public" in server.log_text()


@pytest.mark.parametrize("webhook, place", [
    ({"url": "http://127.0.0.1/"}, "/webhook/url"), ({"url": "http://[::1]/"}, "/webhook/url"),
    ({"url": "http://0x7f.1/"}, "/webhook/url"), ({"url": "http://10.1.2.3/"}, "/webhook/url"),
    ({"url": "http://169.254.169.254/"}, "/webhook/url"),
    ({"url": "https://user:password@example.com/"}, "/webhook/url"),
    ({"url": "https://example.com:70000/"}, "/webhook/url"),
    ({"url": "https://example.com:0/"}, "/webhook/url"), ({"url": "ftp://a.b/"}, "/webhook/url"),
    ({"url": "example.com"}, "/webhook/url"), ({"url": "https://a.b/ c"}, "/webhook/url"),
    ({"url": "https://a.b/\u00e4"}, "/webhook/url"), ({"url": 7}, "/webhook/url"),
    ({"url": "https://a.b/" + "x" * 2037}, "/webhook/url"), ({"url": None}, "/webhook/url"),
    ({}, "/webhook/url"), ("https://a.b/", "/webhook"), (None, "/webhook"),
    ({"url": "https://a.b/", "secret": "x"}, "/webhook/secret")])
def test_what_cannot_be_a_webhook_is_refused_with_its_place(strict, webhook, place):
    request = job_request(webhook=webhook)
    assert_faults(strict.request("POST", "/v1/jobs", request), request, [place])


def test_the_longest_url_is_taken(strict):
    url = "https://192.0.2.1/" + "x" * (2048 - 18)
    problem = assert_problem(strict.request("POST", "/v1/jobs", job_request(**hook(url))), 422)
    assert "not public" in problem["errors"][0]["detail"]


def test_plain_http_has_to_be_allowed(hook_server):
    server = hook_server(http=False)
    request = job_request(**hook("http://127.0.0.1:1/"))
    problem = assert_faults(server.request("POST", "/v1/jobs", request), request, ["/webhook/url"])
    assert "--webhook-allow-http" in problem["errors"][0]["detail"]


def test_without_a_secret_there_are_no_webhooks(server):
    request = job_request(**hook("https://example.com/"))
    assert_faults(server.request("POST", "/v1/jobs", request), request, ["/webhook"])


def test_receivers_of_https_are_checked(hook_server, tmp_path):
    mine, other = Certificate(tmp_path, "mine"), Certificate(tmp_path, "other")
    server = hook_server("--webhook-ca", mine.certificate, http=False)
    with Receiver(tls=mine.server_context()) as good, Receiver(tls=other.server_context()) as bad:
        make_job(server, **hook(bad.url()))
        make_job(server, **hook(good.url()))
        assert good.wait(1)[0].is_signed_with(SECRET)
        until(lambda: "webhook given up" in server.log_text())
        assert bad.messages == []


# --- the secret

def test_secrets_change_on_sighup(hook_server):
    server = hook_server()
    with Receiver() as receiver:
        server.secret.write_text("whsec_nonsense\n")
        server.process.send_signal(signal.SIGHUP)
        until(lambda: "the webhook secret stays as it was" in server.log_text())
        make_job(server, **hook(receiver.url()))
        assert receiver.wait(1)[0].is_signed_with(SECRET)
        server.secret.write_text(f"{OTHER_SECRET}\n{SECRET}\n")
        server.process.send_signal(signal.SIGHUP)
        until(lambda: "webhook secret read again" in server.log_text())

        def is_new():
            make_job(server, **hook(receiver.url()))
            return receiver.wait(len(receiver.messages))[-1].is_signed_with(OTHER_SECRET)

        until(is_new)
        assert receiver.messages[-1].is_signed_with(SECRET)
    assert "nonsense" not in server.log_text()


def test_a_secret_that_is_none_is_refused(tmp_path):
    secret = tmp_path / "secret"
    secret.write_text("whsec_c2hvcnQtc2VjcmV0\n")
    ended = subprocess.run([BIN_DIR / "modelsynthd", "--data", tmp_path / "data", "--listen",
                            "127.0.0.1:0", "--webhook-secret-file", secret],
                           capture_output=True, text=True, timeout=30)
    said = ended.stdout + ended.stderr
    assert ended.returncode != 0 and "line 1" in said and "listening" not in said
    assert "c2hvcnQ" not in said
