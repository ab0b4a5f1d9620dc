"""Lists of jobs, page by page."""

import pytest

from checks import assert_problem, endless_job, make_job, post_job


@pytest.fixture(scope="module")
def listed(tmp_path_factory):
    """A server with 23 finished, 4 failed, 3 cancelled jobs, and their ids, oldest first."""
    from conftest import Server
    server = Server(tmp_path_factory.mktemp("list") / "data").start()
    try:
        jobs = [make_job(server, {"size": [4, 2, 4]}, seed=seed) for seed in range(23)]
        jobs += [make_job(server, {"size": [3, 1, 3], "boundary": {"bottom": "red", "top": "air"}})
                 for _ in range(4)]
        for _ in range(3):
            with endless_job(server, wait_running=False) as job:
                pass
            jobs.append(job)
        yield server, [job["id"] for job in jobs]
    finally:
        server.kill()


def read_pages(server, query):
    ids = []
    cursor = None
    for _ in range(100):
        page = server.get(f"/v1/jobs?{query}" + (f"&cursor={cursor}" if cursor else "")).json()
        assert set(page) == {"items", "next"}
        ids.append([job["id"] for job in page["items"]])
        cursor = page["next"]
        if cursor is None:
            return ids
    raise AssertionError("the pages do not end")


def test_the_list_is_newest_first_twenty_at_a_time(listed):
    server, ids = listed
    page = server.get("/v1/jobs").json()
    assert [job["id"] for job in page["items"]] == ids[:-21:-1]
    assert isinstance(page["next"], str)


@pytest.mark.parametrize("limit", [1, 7, 15, 30, 100])
def test_all_pages_together_are_all_jobs_once(listed, limit):
    server, ids = listed
    pages = read_pages(server, f"limit={limit}")
    assert [job for page in pages for job in page] == ids[::-1]
    assert all(len(page) == limit for page in pages[:-1])
    assert 0 < len(pages[-1]) <= limit


@pytest.mark.parametrize(("state", "span"), [
    ("succeeded", (0, 23)), ("failed", (23, 27)), ("cancelled", (27, 30)), ("queued", (0, 0)),
    ("running", (0, 0))])
def test_the_list_can_be_filtered_by_state(listed, state, span):
    server, ids = listed
    pages = read_pages(server, f"state={state}&limit=5")
    assert [job for page in pages for job in page] == ids[span[0]:span[1]][::-1]


def test_an_item_of_the_list_is_the_job(listed):
    server, ids = listed
    items = {job["id"]: job for job in server.get("/v1/jobs?limit=100").json()["items"]}
    for job_id in (ids[0], ids[24], ids[29]):
        assert items[job_id] == server.get(f"/v1/jobs/{job_id}").json()


def test_a_cursor_stays_where_it_is_when_jobs_come_and_go(make_server):
    server = make_server()
    ids = [make_job(server, {"size": [4, 2, 4]})["id"] for _ in range(6)]
    page = server.get("/v1/jobs?limit=2").json()
    make_job(server, {"size": [4, 2, 4]})
    server.request("DELETE", f"/v1/jobs/{ids[4]}")  # the one the cursor was made from
    rest = server.get(f"/v1/jobs?limit=10&cursor={page['next']}").json()
    assert [job["id"] for job in rest["items"]] == ids[3::-1]


@pytest.mark.parametrize(("query", "status"), [
    ("limit=0", 422), ("limit=101", 422), ("limit=-1", 422), ("limit=ten", 400), ("limit=", 400),
    ("limit=1.5", 400), ("limit=99999999999999999999", 422), ("cursor=%21%21", 400),
    ("cursor=not-a-cursor", 400), ("state=done", 422), ("state=", 422), ("State=failed", 400),
    ("bogus=1", 400), ("limit=1&limit=2", 400), ("limit=%zz", 400),
])
def test_a_wrong_query_is_refused_not_ignored(server, query, status):
    answer = server.get(f"/v1/jobs?{query}")
    assert_problem(answer, status, instance="/v1/jobs")
