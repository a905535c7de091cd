"""The dialogs that save and open config files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import viser

from webviz.api.panel import Send
from webviz.edges.gui.dialogs import Dialog
from webviz.edges.gui.file_names import NEW_NAME, file_name
from webviz.edges.gui.text import note_html, plain
from webviz.engine.commands import Export, Load, Open, Save
from webviz.engine.state import File, State
from webviz.files.config.files import SUFFIXES

NOTHING: str = "(none)"


class SaveAs(Dialog):
    """Asks for a name in the folder, or sends the file to the browser.

    Args:
        client: the browser that asked.
        send: takes commands, from any thread.
        file: what the viewer says of its file.
    """

    def __init__(self, client: viser.ClientHandle, send: Send, file: File) -> None:
        super().__init__(client.gui, "Save as")
        self._client = client
        self._send = send
        self._file = file
        self._confirmed = ""
        gui = self.gui
        with self.modal:
            gui.add_html(note_html(f"In {file.folder} of the machine that runs webviz:"))
            form = gui.add_form(None)
            with form:
                self._name = gui.add_text("File name", plain(_name_of(file)))
                self._note = gui.add_html("")
                gui.add_button("Save", icon=viser.Icon.DEVICE_FLOPPY).on_click(
                    lambda _: self._save()
                )
            form.on_submit(lambda _: self._save())
            gui.add_button(
                "Download to this computer", icon=viser.Icon.DOWNLOAD, color="gray"
            ).on_click(lambda _: self._download())
            gui.add_button("Cancel", color="gray").on_click(lambda _: self.finish())

    def update(self, state: State) -> None:
        """Know which files there are."""
        self._file = state.file

    def _save(self) -> None:
        if (name := self._checked_name()) is None or self.is_done:
            return
        is_own = name == Path(self._file.path).name
        if name in self._file.others and not is_own and self._confirmed != name:
            self._confirmed = name
            self._say(f"{name} exists already. Save again to replace it.")
            return
        self._send(Save(name), self._client.client_id)
        self.finish()

    def _download(self) -> None:
        if (name := self._checked_name()) is None:
            return
        client = self._client

        def deliver(text: str) -> None:
            client.send_file_download(name, text.encode(), save_immediately=True)

        self._send(Export(deliver, name), client.client_id)
        self.finish()

    def _checked_name(self) -> str | None:
        try:
            return file_name(self._name.value)
        except ValueError as error:
            self._say(str(error))
            return None

    def _say(self, text: str) -> None:
        self._note.content = note_html(text, is_warning=True)


class OpenFile(Dialog):
    """Offers the config files of the folder, and takes one from the browser.

    Args:
        client: the browser that asked.
        replace: called with the command that opens a file, from any thread.
        file: what the viewer says of its file.
    """

    def __init__(
        self, client: viser.ClientHandle, replace: Callable[[Open | Load], None], file: File
    ) -> None:
        super().__init__(client.gui, "Open")
        self._replace = replace
        self._names: dict[str, str] = {}
        self._chosen: str | None = None
        gui = self.gui
        with self.modal:
            # First, since the first control gets the focus, at which a choice would unfold.
            upload = gui.add_upload_button(
                "Upload from this computer",
                icon=viser.Icon.UPLOAD,
                color="gray",
                mime_type=",".join(SUFFIXES),
            )
            upload.on_upload(self._upload)
            gui.add_html(note_html(f"Or from {file.folder} of the machine that runs webviz:"))
            self._choice = gui.add_dropdown("File", (NOTHING,))
            self._button = gui.add_button("Open", icon=viser.Icon.FOLDER_OPEN)
            self._button.on_click(lambda _: self._open())
            gui.add_button("Cancel", color="gray").on_click(lambda _: self.finish())

    def update(self, state: State) -> None:
        """Show the files there are now."""
        names = {plain(name): name for name in state.file.others} or {NOTHING: ""}
        if names != self._names:
            self._names = names
            self._choice.options = tuple(names)
        self._button.disabled = NOTHING in names

    def _open(self) -> None:
        if name := self._names.get(self._choice.value):
            self._replace(Open(name))
            self.finish()

    def _upload(self, event: viser.GuiEvent[viser.GuiUploadButtonHandle]) -> None:
        file = event.target.value
        try:
            text = file.content.decode()
        except UnicodeDecodeError:
            if event.client is not None:
                event.client.add_notification(
                    "Not opened", f"{plain(file.name)} is not UTF-8 text.", color="red"
                )
            return
        self._replace(Load(text, Path(file.name).name))
        self.finish()


class Discard(Dialog):
    """Asks before a file takes the place of changes that nobody has saved.

    Args:
        client: the browser that asked.
        send: takes commands, from any thread.
        command: opens the file.
    """

    def __init__(self, client: viser.ClientHandle, send: Send, command: Open | Load) -> None:
        super().__init__(client.gui, "Unsaved changes")
        self._browser = client.client_id
        self._send = send
        self._command = command
        gui = self.gui
        name = command.path if isinstance(command, Open) else command.name
        with self.modal:
            text = f"Open {name} and discard unsaved changes? Everyone on this page loses them."
            gui.add_html(note_html(text, is_warning=True))
            # First, since the first control gets the focus, and Enter must not discard.
            gui.add_button("Cancel", color="gray").on_click(lambda _: self.finish())
            gui.add_button("Discard", icon=viser.Icon.TRASH, color="red").on_click(
                lambda _: self._discard()
            )

    def _discard(self) -> None:
        if not self.is_done:
            self.finish()
            self._send(self._command, self._browser)


def _name_of(file: File) -> str:
    return Path(file.path).name if file.path else NEW_NAME
