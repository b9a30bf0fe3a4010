"""What tests and doctests share: they keep out of the user's cache of built files."""

import pytest


@pytest.fixture(autouse=True, scope="session")
def cache_of_the_tests(tmp_path_factory):
    from foveal.scene import prepare

    folder = tmp_path_factory.mktemp("built")

    def cache_folder():
        """Where built files are kept."""
        return folder

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(prepare, "cache_folder", cache_folder)
        yield
