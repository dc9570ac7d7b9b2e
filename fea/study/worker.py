"""The process that computes variants one after another: ``python -m alula.fea.study.worker``.

The first request is pickled: the files of the case's parts. Each later one is a pickled ``Task``; its answer is the
pickled ``VariantResult``.
"""

import pickle
from collections.abc import Mapping

from alula.fea.study.evaluate import Task, evaluate
from alula.geometry.base.child_server import ChildService


def main() -> None:
    """Answer requests until the parent ends."""
    service = ChildService()
    contents: Mapping[str, bytes] = {}

    def answer(request: bytes) -> None:
        nonlocal contents
        asked = pickle.loads(request)
        if not isinstance(asked, Task):
            contents = asked
            service.reply(b"")
            return
        service.reply(pickle.dumps(evaluate(asked, contents)))

    service.run(answer)


if __name__ == "__main__":
    main()
