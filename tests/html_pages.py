"""Pages as a browser reads them: their tags, text and addresses."""

from html.parser import HTMLParser

VOID = {"meta", "img", "br", "hr", "link", "input", "wbr"}


class Page(HTMLParser):
    """Checks that tags are closed in order, and collects text, attributes and images."""

    def __init__(self, text):
        super().__init__()
        self.source, self.open, self.text, self.attributes = text, [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.attributes += [(tag, name, value) for name, value in attrs]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if "style" not in self.open:
            self.text.append(data)

    @property
    def words(self):
        return " ".join(" ".join(self.text).split())


def stands_alone(page: Page, beside: tuple[str, ...] = ()) -> None:
    """Assert that a page loads nothing from elsewhere; its links lead to places in it or to files beside it."""
    for tag, name, value in page.attributes:
        assert tag not in ("link", "iframe", "object")
        assert (tag, name) != ("script", "src")
        if name in ("src", "href", "srcset", "style"):
            assert value.startswith(("data:image/png;base64,", "data:image/webp;base64,", "#")) or value in beside, (
                tag,
                name,
                value,
            )
    assert "url(" not in page.source
    assert "@import" not in page.source
    ids = [value for _, name, value in page.attributes if name == "id"]
    assert len(set(ids)) == len(ids)
    links = {value for tag, name, value in page.attributes if (tag, name) == ("a", "href") and value not in beside}
    assert {value[1:] for value in links} <= set(ids)
