//! Translates winit's keys to `bevy_input`'s.

use bevy_input::keyboard::{Key, KeyCode, NativeKey, NativeKeyCode};
use winit::keyboard as from;

/// The variant of another enum with the same name as `value`'s, or `otherwise` if there is none.
macro_rules! same_name {
    ($value:expr, $from:path => $to:path, $otherwise:expr; $($name:ident)+) => {{
        use $from as From;
        use $to as To;
        match $value {
            $(From::$name => To::$name,)+
            _ => $otherwise,
        }
    }};
}

/// The physical key, independent of the layout.
pub(crate) fn physical(key: from::PhysicalKey) -> KeyCode {
    match key {
        from::PhysicalKey::Code(code) => physical_code(code),
        from::PhysicalKey::Unidentified(native) => KeyCode::Unidentified(match native {
            from::NativeKeyCode::Unidentified => NativeKeyCode::Unidentified,
            from::NativeKeyCode::Android(code) => NativeKeyCode::Android(code),
            from::NativeKeyCode::MacOS(code) => NativeKeyCode::MacOS(code),
            from::NativeKeyCode::Windows(code) => NativeKeyCode::Windows(code),
            from::NativeKeyCode::Xkb(code) => NativeKeyCode::Xkb(code),
        }),
    }
}

fn physical_code(code: from::KeyCode) -> KeyCode {
    same_name!(code, from::KeyCode => KeyCode, KeyCode::Unidentified(NativeKeyCode::Unidentified);
        Backquote Backslash BracketLeft BracketRight Comma
        Digit0 Digit1 Digit2 Digit3 Digit4 Digit5 Digit6 Digit7 Digit8 Digit9
        Equal IntlBackslash IntlRo IntlYen
        KeyA KeyB KeyC KeyD KeyE KeyF KeyG KeyH KeyI KeyJ KeyK KeyL KeyM
        KeyN KeyO KeyP KeyQ KeyR KeyS KeyT KeyU KeyV KeyW KeyX KeyY KeyZ
        Minus Period Quote Semicolon Slash
        AltLeft AltRight Backspace CapsLock ContextMenu ControlLeft ControlRight Enter SuperLeft SuperRight
        ShiftLeft ShiftRight Space Tab
        Convert KanaMode Lang1 Lang2 Lang3 Lang4 Lang5 NonConvert
        Delete End Help Home Insert PageDown PageUp
        ArrowDown ArrowLeft ArrowRight ArrowUp
        NumLock Numpad0 Numpad1 Numpad2 Numpad3 Numpad4 Numpad5 Numpad6 Numpad7 Numpad8 Numpad9
        NumpadAdd NumpadBackspace NumpadClear NumpadClearEntry NumpadComma NumpadDecimal NumpadDivide NumpadEnter
        NumpadEqual NumpadHash NumpadMemoryAdd NumpadMemoryClear NumpadMemoryRecall NumpadMemoryStore
        NumpadMemorySubtract NumpadMultiply NumpadParenLeft NumpadParenRight NumpadStar NumpadSubtract
        Escape Fn FnLock PrintScreen ScrollLock Pause
        BrowserBack BrowserFavorites BrowserForward BrowserHome BrowserRefresh BrowserSearch BrowserStop
        Eject LaunchApp1 LaunchApp2 LaunchMail
        MediaPlayPause MediaSelect MediaStop MediaTrackNext MediaTrackPrevious
        Power Sleep AudioVolumeDown AudioVolumeMute AudioVolumeUp WakeUp
        Meta Hyper Turbo Abort Resume Suspend Again Copy Cut Find Open Paste Props Select Undo Hiragana Katakana
        F1 F2 F3 F4 F5 F6 F7 F8 F9 F10 F11 F12 F13 F14 F15 F16 F17 F18 F19 F20 F21 F22 F23 F24
        F25 F26 F27 F28 F29 F30 F31 F32 F33 F34 F35
    )
}

/// The meaning of the key under the layout.
pub(crate) fn logical(key: &from::Key) -> Key {
    match key {
        // `into`, because `bevy_input` holds a `String` or a `SmolStr`, depending on its features.
        from::Key::Character(text) => Key::Character(text.as_str().into()),
        from::Key::Dead(accent) => Key::Dead(*accent),
        from::Key::Named(name) => named(*name),
        from::Key::Unidentified(native) => Key::Unidentified(match native {
            from::NativeKey::Unidentified => NativeKey::Unidentified,
            from::NativeKey::Android(code) => NativeKey::Android(*code),
            from::NativeKey::MacOS(code) => NativeKey::MacOS(*code),
            from::NativeKey::Windows(code) => NativeKey::Windows(*code),
            from::NativeKey::Xkb(code) => NativeKey::Xkb(*code),
            from::NativeKey::Web(name) => NativeKey::Web(name.as_str().into()),
        }),
    }
}

/// The keys of computers; those of televisions and telephones are unidentified.
fn named(name: from::NamedKey) -> Key {
    same_name!(name, from::NamedKey => Key, Key::Unidentified(NativeKey::Unidentified);
        Alt AltGraph CapsLock Control Fn FnLock NumLock ScrollLock Shift Symbol SymbolLock Meta Hyper Super
        Enter Tab Space ArrowDown ArrowLeft ArrowRight ArrowUp End Home PageDown PageUp
        Backspace Clear Copy CrSel Cut Delete EraseEof ExSel Insert Paste Redo Undo
        Accept Again Attn Cancel ContextMenu Escape Execute Find Help Pause Play Props Select ZoomIn ZoomOut
        BrightnessDown BrightnessUp Eject LogOff Power PowerOff PrintScreen Hibernate Standby WakeUp
        AllCandidates Alphanumeric CodeInput Compose Convert FinalMode GroupFirst GroupLast GroupNext GroupPrevious
        ModeChange NextCandidate NonConvert PreviousCandidate Process SingleCandidate
        HangulMode HanjaMode JunjaMode Eisu Hankaku Hiragana HiraganaKatakana KanaMode KanjiMode Katakana Romaji
        Zenkaku ZenkakuHankaku Soft1 Soft2 Soft3 Soft4
        Close MailForward MailReply MailSend New Open Print Save SpellCheck
        MediaClose MediaFastForward MediaPause MediaPlay MediaPlayPause MediaRecord MediaRewind MediaStop
        MediaTrackNext MediaTrackPrevious AudioVolumeDown AudioVolumeUp AudioVolumeMute
        MicrophoneToggle MicrophoneVolumeDown MicrophoneVolumeUp MicrophoneVolumeMute
        LaunchApplication1 LaunchApplication2 LaunchCalendar LaunchContacts LaunchMail LaunchMediaPlayer
        LaunchMusicPlayer LaunchPhone LaunchScreenSaver LaunchSpreadsheet LaunchWebBrowser LaunchWebCam
        LaunchWordProcessor
        BrowserBack BrowserFavorites BrowserForward BrowserHome BrowserRefresh BrowserSearch BrowserStop
        F1 F2 F3 F4 F5 F6 F7 F8 F9 F10 F11 F12 F13 F14 F15 F16 F17 F18 F19 F20 F21 F22 F23 F24
        F25 F26 F27 F28 F29 F30 F31 F32 F33 F34 F35
    )
}

/// The command character of a key, in lower case.
///
/// Digits are the keys of the digit row and of the number pad, whatever they type with or without Shift. For other keys
/// it is the character of the layout, so that Q is the key labelled Q; on layouts of other alphabets, which have no Q,
/// it is the key at the position of Q on a US keyboard. `+` and `-` are also the keys that type them with Shift, and
/// `=` is taken as `+`, `_` as `-`.
pub(crate) fn command(key_code: KeyCode, logical_key: &Key) -> Option<char> {
    if let Some(digit) = digit(key_code) {
        return Some(digit);
    }
    let Key::Character(text) = logical_key else { return None };
    let mut characters = text.chars();
    let (Some(character), None) = (characters.next(), characters.next()) else { return None };
    match character.to_ascii_lowercase() {
        '=' => Some('+'),
        '_' => Some('-'),
        character if character.is_ascii() => Some(character),
        _ => us_character(key_code),
    }
}

fn digit(key_code: KeyCode) -> Option<char> {
    Some(match key_code {
        KeyCode::Digit1 | KeyCode::Numpad1 => '1',
        KeyCode::Digit2 | KeyCode::Numpad2 => '2',
        KeyCode::Digit3 | KeyCode::Numpad3 => '3',
        _ => return None,
    })
}

/// The commands' characters on a US keyboard.
fn us_character(key_code: KeyCode) -> Option<char> {
    Some(match key_code {
        KeyCode::KeyB => 'b',
        KeyCode::KeyQ => 'q',
        KeyCode::KeyR => 'r',
        KeyCode::Equal => '+',
        KeyCode::Minus => '-',
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn character(text: &str) -> Key {
        Key::Character(text.into())
    }

    #[test]
    fn physical_keys_keep_their_names() {
        use from::KeyCode as From;
        let rows = [
            (From::KeyA, KeyCode::KeyA),
            (From::KeyZ, KeyCode::KeyZ),
            (From::Digit0, KeyCode::Digit0),
            (From::Digit9, KeyCode::Digit9),
            (From::ArrowLeft, KeyCode::ArrowLeft),
            (From::ArrowUp, KeyCode::ArrowUp),
            (From::ShiftLeft, KeyCode::ShiftLeft),
            (From::ControlRight, KeyCode::ControlRight),
            (From::AltRight, KeyCode::AltRight),
            (From::SuperLeft, KeyCode::SuperLeft),
            (From::F1, KeyCode::F1),
            (From::F12, KeyCode::F12),
            (From::F35, KeyCode::F35),
            (From::Space, KeyCode::Space),
            (From::Enter, KeyCode::Enter),
            (From::Escape, KeyCode::Escape),
            (From::Tab, KeyCode::Tab),
            (From::Backspace, KeyCode::Backspace),
            (From::Home, KeyCode::Home),
            (From::PageDown, KeyCode::PageDown),
            (From::Minus, KeyCode::Minus),
            (From::NumpadAdd, KeyCode::NumpadAdd),
            (From::NumpadSubtract, KeyCode::NumpadSubtract),
            (From::IntlBackslash, KeyCode::IntlBackslash),
            (From::Katakana, KeyCode::Katakana),
        ];
        for (winit, expected) in rows {
            assert_eq!(physical(from::PhysicalKey::Code(winit)), expected);
        }
    }

    #[test]
    fn a_key_without_a_name_keeps_its_number() {
        let key = from::PhysicalKey::Unidentified(from::NativeKeyCode::Xkb(84));
        assert_eq!(physical(key), KeyCode::Unidentified(NativeKeyCode::Xkb(84)));
    }

    #[test]
    fn logical_keys() {
        use from::{Key as From, NamedKey};
        let rows = [
            (From::Character("ß".into()), character("ß")),
            (From::Dead(Some('^')), Key::Dead(Some('^'))),
            (From::Named(NamedKey::Shift), Key::Shift),
            (From::Named(NamedKey::Escape), Key::Escape),
            (From::Named(NamedKey::F5), Key::F5),
            (From::Named(NamedKey::AudioVolumeUp), Key::AudioVolumeUp),
            (From::Named(NamedKey::Teletext), Key::Unidentified(NativeKey::Unidentified)),
            (From::Unidentified(from::NativeKey::Xkb(7)), Key::Unidentified(NativeKey::Xkb(7))),
        ];
        for (winit, expected) in rows {
            assert_eq!(logical(&winit), expected, "{winit:?}");
        }
    }

    #[test]
    fn commands_under_several_layouts() {
        let rows = [
            ("US, q", KeyCode::KeyQ, character("q"), Some('q')),
            ("US with caps lock", KeyCode::KeyB, character("B"), Some('b')),
            ("French: the key left of Z says Q", KeyCode::KeyA, character("q"), Some('q')),
            ("French: the key where US has Q says A", KeyCode::KeyQ, character("a"), Some('a')),
            ("French: 1 types &", KeyCode::Digit1, character("&"), Some('1')),
            ("US: Shift+3 types #", KeyCode::Digit3, character("#"), Some('3')),
            ("number pad without NumLock", KeyCode::Numpad2, Key::ArrowDown, Some('2')),
            ("US, =", KeyCode::Equal, character("="), Some('+')),
            ("US, Shift+-", KeyCode::Minus, character("_"), Some('-')),
            ("German +", KeyCode::BracketRight, character("+"), Some('+')),
            ("German -", KeyCode::Slash, character("-"), Some('-')),
            ("number pad +", KeyCode::NumpadAdd, character("+"), Some('+')),
            ("Russian, where US has B", KeyCode::KeyB, character("и"), Some('b')),
            ("Russian, where US has R", KeyCode::KeyR, character("к"), Some('r')),
            ("Russian, where US has X", KeyCode::KeyX, character("ч"), None),
            ("several characters", KeyCode::KeyQ, character("qq"), None),
            ("a key that types nothing", KeyCode::ShiftLeft, Key::Shift, None),
        ];
        for (name, key_code, key, expected) in rows {
            assert_eq!(command(key_code, &key), expected, "{name}");
        }
    }
}
