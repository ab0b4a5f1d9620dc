"""The page to start from in a browser, on a server that asks for a key."""

import json
import shutil
import subprocess

import pytest

from checks import wait_until
from conftest import Server
from test_access import SECRETS, all_keys, write_keys
from websocket_client import TEXT, WebSocketClient

pytestmark = pytest.mark.skipif(shutil.which("chromium") is None,
                                reason="chromium is not installed")


class Browser:
    """A page in headless chromium, spoken to over the DevTools protocol."""

    def __init__(self, folder):
        self.process = subprocess.Popen(
            ["chromium", "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={folder}",
             "--remote-debugging-port=0", "about:blank"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        told = folder / "DevToolsActivePort"
        wait_until(lambda: told.exists() and len(told.read_text().split("\n")) == 2)
        port, path = told.read_text().split("\n")
        self.socket = WebSocketClient(int(port), path, protocol=None, timeout=60)
        self.count = 0
        self.session = None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call(
            "Target.attachToTarget", targetId=target, flatten=True)["sessionId"]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.abort()
        self.process.kill()
        self.process.wait(timeout=60)

    def call(self, method, **parameters):
        self.count += 1
        message = {"id": self.count, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        self.socket.send(TEXT, json.dumps(message).encode())
        while True:
            answer = json.loads(self.socket.message().payload)
            if answer.get("id") == self.count:
                assert "error" not in answer, answer
                return answer["result"]

    def run(self, script):
        """The value of an expression in the page."""
        done = self.call("Runtime.evaluate", expression=script, awaitPromise=True,
                         returnByValue=True)
        assert "exceptionDetails" not in done, done
        return done["result"].get("value")

    def open(self, url):
        self.call("Page.navigate", url=url)
        wait_until(lambda: self.run("document.readyState") == "complete" and
                   self.run("location.href").startswith(url))

    def shows(self, selector):
        return self.run(f"!!document.querySelector({json.dumps(selector)})?.checkVisibility()")

    def text(self, name):
        return self.run(f"document.getElementById({json.dumps(name)}).textContent")


@pytest.fixture
def browser(tmp_path):
    with Browser(tmp_path / "browser") as opened:
        yield opened


@pytest.fixture
def keyed(tmp_path):
    server = Server(tmp_path / "data", "--keys", write_keys(tmp_path / "keys.json", all_keys()))
    yield server.start()
    server.kill()


def unlock(browser, key):
    browser.run(f"at('key').value = {json.dumps(key)}; at('unlock').requestSubmit();")


def make_model(browser):
    browser.run("['x', 'y', 'z'].forEach((axis) => { at(axis).value = 8; });"
                "at('request').requestSubmit();")
    wait_until(lambda: "model.glb" in browser.text("links"))


def test_a_key_is_asked_for_where_it_is_needed_and_is_then_enough(browser, keyed):
    browser.open(keyed.url)
    wait_until(lambda: browser.shows("#key"))
    assert not browser.shows("#request")
    unlock(browser, "nobody's key")
    wait_until(lambda: "does not know" in browser.text("wanted"))
    assert browser.shows("#key") and not browser.shows("#request")
    unlock(browser, SECRETS["ann"])
    wait_until(lambda: browser.shows("#request"))
    assert not browser.shows("#key")
    make_model(browser)
    # What a link leads to is fetched with the key, and saved.
    browser.run("URL.createObjectURL = (blob) => { window.saved = blob; return 'data:,'; };"
                "document.querySelector('#links a').click();")
    wait_until(lambda: browser.run("window.saved?.size > 0"))
    assert browser.run("window.saved.slice(0, 4).text()") == "glTF"
    # It is kept nowhere.
    assert browser.run("document.cookie + JSON.stringify({ ...localStorage, ...sessionStorage })"
                       " + location.href") == "{}" + browser.run("location.href")
    assert SECRETS["ann"] not in browser.run("location.href")
    browser.open(f"{keyed.url}/?again")
    wait_until(lambda: browser.shows("#key"))


def test_a_key_that_may_only_read_is_told_so(browser, keyed):
    browser.open(keyed.url)
    wait_until(lambda: browser.shows("#key"))
    unlock(browser, SECRETS["reader"])
    wait_until(lambda: browser.shows("#request"))
    browser.run("at('request').requestSubmit();")
    wait_until(lambda: "The key is not for this" in browser.text("state"))


def test_where_no_key_is_needed_none_is_asked_for(browser, server):
    browser.open(server.url)
    wait_until(lambda: browser.run("examples.size") > 0)
    assert browser.shows("#request") and not browser.shows("#key")
    make_model(browser)
