"""The process that computes variants one after another: ``python -m fea.study.worker``.

The first request is pickled: the files of the case's parts. Each later one is a pickled ``Task``; its answer is the
pickled ``VariantResult``, or the sentence of what cannot run.
"""

import pickle
from collections.abc import Mapping

from fea.study.evaluate import Task, evaluate
from geometry.base.child_server import ChildService
from geometry.base.errors import CannotRunError


def main() -> None:
    """VariantResult requests until the parent ends."""
    service = ChildService()
    contents: Mapping[str, bytes] = {}

    def answer(request: bytes) -> None:
        nonlocal contents
        asked = pickle.loads(request)
        if not isinstance(asked, Task):
            contents = asked
            service.reply(b"")
            return
        try:
            told: object = evaluate(asked, contents)
        except CannotRunError as error:
            told = str(error)
        except MemoryError:
            told = "the memory of the worker does not suffice"
        service.reply(pickle.dumps(told))

    service.run(answer)


if __name__ == "__main__":
    main()
