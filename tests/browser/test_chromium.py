"""What the driver of Chromium says of a page is of that page alone."""

from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from threading import Thread


class Impatient(BaseHTTPRequestHandler):
    """A page that asks for events again as soon as their stream ends, which it does at once."""

    def do_GET(self):
        """Answer with the page, or with a stream of nothing."""
        kind, body = ("text/event-stream", b"retry: 1\n\n") if self.path == "/events" else ("text/html", PAGE)
        self.send_response(200)
        self.send_header("Content-Type", kind)
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *told):
        """Say nothing."""


PAGE = b"<!doctype html><title>Impatient</title><script>new EventSource('/events')</script>"


def test_requests_are_those_of_the_page_that_was_opened(browser, tmp_path):
    """A page that was open before goes on to ask until it is left: nothing of that is counted to the next one."""
    quiet = tmp_path / "quiet.html"
    quiet.write_text("<!doctype html><title>Quiet</title>", encoding="utf-8")
    with ThreadingHTTPServer(("127.0.0.1", 0), Impatient) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        address = f"http://127.0.0.1:{server.server_address[1]}/"
        for _ in range(5):
            browser.open(address)
            assert browser.requests().count(f"{address}events") > 0
            browser.open(quiet)
            assert browser.requests() == [quiet.as_uri()]
        server.shutdown()
