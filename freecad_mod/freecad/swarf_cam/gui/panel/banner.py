# SPDX-License-Identifier: LGPL-2.1-or-later
"""A line over the picture: what went wrong with what can be done about it, or work with progress and cancel."""

import FreeCAD

from ..qt import QtCore, QtWidgets

translate = FreeCAD.Qt.translate

STYLES = {"error": "background: #b3282d; color: white;", "warning": "background: #f0b429; color: #1d1600;",
          "note": "background: #2f6fab; color: white;"}


# Pixels between the message and the borders of the picture.
MARGIN = 8


class Banner(QtWidgets.QFrame):
    """One message at a time."""

    cancelled = QtCore.Signal()

    def __init__(self, view):
        super().__init__(view)
        view.installEventFilter(self)
        self.setObjectName("SwarfBanner")
        row = QtWidgets.QHBoxLayout(self)
        row.setContentsMargins(10, 5, 6, 5)
        self.text = QtWidgets.QLabel()
        self.text.setObjectName("SwarfMessage")
        self.text.setWordWrap(True)
        row.addWidget(self.text, 1)
        self.bar = QtWidgets.QProgressBar()
        self.bar.setRange(0, 1000)
        self.bar.setMaximumWidth(160)
        row.addWidget(self.bar)
        self.action = QtWidgets.QPushButton()
        self.action.setObjectName("SwarfAction")
        row.addWidget(self.action)
        self.close_button = QtWidgets.QToolButton()
        self.close_button.setText("✕")
        self.close_button.setAutoRaise(True)
        self.close_button.setToolTip(translate("Swarf", "Close"))
        self.close_button.clicked.connect(lambda *_: self.hide())
        row.addWidget(self.close_button)
        self._act = None
        self.action.clicked.connect(self._clicked)
        self.hide()

    def eventFilter(self, watched, event):
        """Stay at the lower border of the picture."""
        if event.type() == QtCore.QEvent.Resize:
            self._place()
        return False

    def _place(self):
        view = self.parentWidget()
        width = view.width() - 2 * MARGIN
        height = max(self.layout().heightForWidth(width), self.sizeHint().height())
        self.setGeometry(MARGIN, view.height() - height - MARGIN, width, height)

    def _clicked(self, *_):
        if self._act is not None:
            self._act()

    def say(self, kind, text, action=None, act=None):
        """A message of kind "error", "warning" or "note"; action: text of a button that calls act."""
        self.setStyleSheet("#SwarfBanner { border-radius: 5px; %s } #SwarfMessage { %s } "
                           "#SwarfBanner QToolButton { %s }" % ((STYLES[kind],) * 3))
        self.text.setText(text)
        self.bar.hide()
        self.close_button.show()
        self._act = act
        self.action.setVisible(act is not None)
        self.action.setText(action or "")
        self._place()
        self.show()
        self.raise_()

    def work(self, text, cancel, measured=True):
        """Work that goes on, with a button to end it; measured: how far it is will be told by progress()."""
        self.say("note", text, translate("Swarf", "Cancel"), cancel)
        self.close_button.hide()
        self.bar.setRange(0, 1000 if measured else 0)
        self.bar.setValue(0)
        self.bar.show()
        self._place()

    @property
    def working(self):
        """Whether it shows work."""
        return self.bar.isVisibleTo(self) and self.isVisibleTo(self.parentWidget())

    def progress(self, fraction):
        """Part of the work that is done."""
        self.bar.setValue(int(1000 * fraction))

    def done(self):
        """Nothing to say any more."""
        self.hide()
